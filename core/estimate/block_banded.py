"""Symmetric systems in which each frame meets only its two neighbours on either side.

Frames are taken in pairs, which makes the block-pentadiagonal matrix block-tridiagonal; a block Cholesky
factorisation then solves it, and its backward recursion gives the diagonal blocks of the inverse (the
Rauch-Tung-Striebel smoother in information form; Särkkä 2013, *Bayesian Filtering and Smoothing*, ch. 8;
Takahashi, Fagan & Chen 1973 for the selected inverse). Time and memory grow linearly with the clip.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

Array = NDArray[np.float64]

REACH = 2
"""A frame is coupled to at most this many frames after it."""


class BlockBanded:
    """A symmetric positive definite matrix of F x F blocks, and what is solved with it."""

    def __init__(self, frames: int, size: int) -> None:
        """An all-zero matrix of `frames` blocks of `size` rows."""
        self.frames, self.size = frames, size
        self.bands = [np.zeros((max(frames - k, 0), size, size)) for k in range(REACH + 1)]
        """bands[k][t] is the block that couples frame t (rows) to frame t + k (columns)."""

    def copy(self) -> "BlockBanded":
        """An independent copy."""
        other = BlockBanded(self.frames, self.size)
        other.bands = [band.copy() for band in self.bands]
        return other

    def add_rows(self, jacobians: tuple[Array, ...]) -> None:
        """Add JᵀJ of whitened rows that couple consecutive frames.

        Args:
            jacobians: One (F - K, m, n) array for each of the K + 1 frames a row touches, n ≤ size
                (the leading unknowns of a frame).
        """
        rows = len(jacobians[0])
        n = jacobians[0].shape[-1]
        for first, left in enumerate(jacobians):
            for second in range(first, len(jacobians)):
                product = np.swapaxes(left, -1, -2) @ jacobians[second]
                self.bands[second - first][first : first + rows, :n, :n] += product

    def multiply(self, vector: Array) -> Array:
        """The product with a vector (F, size)."""
        result = np.einsum("fij,fj->fi", self.bands[0], vector)
        for k in range(1, REACH + 1):
            band = self.bands[k]
            result[: len(band)] += np.einsum("fij,fj->fi", band, vector[k:])
            result[k:] += np.einsum("fji,fj->fi", band, vector[: len(band)])
        return result

    def factorise(self) -> "Factor":
        """The Cholesky factorisation; LinAlgError where the matrix is not positive definite."""
        diagonal, coupling = self._pairs()
        factors: list[tuple[Array, bool]] = []
        for g, block in enumerate(diagonal):
            if g > 0:
                block = block - coupling[g - 1].T @ cho_solve(factors[-1], coupling[g - 1])
            factors.append(cho_factor(0.5 * (block + block.T), lower=True))
        return Factor(self.frames, self.size, tuple(factors), coupling)

    def _pairs(self) -> tuple[Array, Array]:
        """Diagonal (G, 2n, 2n) and upper (G - 1, 2n, 2n) blocks of the matrix taken two frames at a time."""
        n, pairs = self.size, (self.frames + 1) // 2
        diagonal = np.zeros((pairs, 2 * n, 2 * n))
        coupling = np.zeros((max(pairs - 1, 0), 2 * n, 2 * n))
        zeroth, first, second = self.bands
        even, odd = zeroth[0::2], zeroth[1::2]
        diagonal[: len(even), :n, :n] = even
        diagonal[: len(odd), n:, n:] = odd
        if self.frames % 2:  # a frame that is not there
            diagonal[-1, n:, n:] = np.eye(n)
        within, between = first[0::2], first[1::2]
        diagonal[: len(within), :n, n:] = within
        diagonal[: len(within), n:, :n] = np.swapaxes(within, -1, -2)
        coupling[: len(between), n:, :n] = between
        coupling[: len(second[0::2]), :n, :n] = second[0::2]
        coupling[: len(second[1::2]), n:, n:] = second[1::2]
        return diagonal, coupling


@dataclass(frozen=True, eq=False)
class Factor:
    """A factorised `BlockBanded` matrix."""

    frames: int
    size: int
    factors: tuple[tuple[Array, bool], ...]
    coupling: Array

    def solve(self, vector: Array) -> Array:
        """The solution (F, size) for a right-hand side (F, size)."""
        pairs, width = len(self.factors), 2 * self.size
        right = np.zeros((pairs, width))
        right.reshape(-1, self.size)[: self.frames] = vector
        for g in range(1, pairs):
            right[g] -= self.coupling[g - 1].T @ cho_solve(self.factors[g - 1], right[g - 1])
        solution = np.zeros_like(right)
        for g in reversed(range(pairs)):
            rest = right[g]
            if g + 1 < pairs:
                rest = rest - self.coupling[g] @ solution[g + 1]
            solution[g] = cho_solve(self.factors[g], rest)
        return np.array(solution.reshape(-1, self.size)[: self.frames])

    def covariance_blocks(self) -> Array:
        """The diagonal blocks (F, size, size) of the inverse."""
        pairs, n = len(self.factors), self.size
        blocks = np.zeros((2 * pairs, n, n))
        below = np.zeros((2 * n, 2 * n))
        for g in reversed(range(pairs)):
            covariance = cho_solve(self.factors[g], np.eye(2 * n))
            if g + 1 < pairs:
                gain = cho_solve(self.factors[g], self.coupling[g])
                covariance = covariance + gain @ below @ gain.T
            below = 0.5 * (covariance + covariance.T)
            blocks[2 * g], blocks[2 * g + 1] = below[:n, :n], below[n:, n:]
        return np.array(blocks[: self.frames])
