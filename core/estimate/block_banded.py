"""Symmetric systems in which each frame meets only its two neighbours on either side.

LAPACK's band Cholesky factorisation solves them. Taken two frames at a time the factor is block-bidiagonal,
and a backward recursion over its blocks gives the diagonal blocks of the inverse (the Rauch-Tung-Striebel
smoother in information form; Särkkä 2013, *Bayesian Filtering and Smoothing*, ch. 8; Takahashi, Fagan &
Chen 1973 for the selected inverse). Time and memory grow linearly with the clip.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded, solve_triangular

Array = NDArray[np.float64]

REACH = 2
"""A frame is coupled to at most this many frames after it."""


class BlockBanded:
    """A symmetric positive definite matrix of F x F blocks, and what is solved with it.

    Neighbouring frames couple all their unknowns; frames two apart couple like unknowns only, as second
    differences do, which keeps the band narrow.
    """

    def __init__(self, frames: int, size: int) -> None:
        """An all-zero matrix of `frames` blocks of `size` rows."""
        self.frames, self.size = frames, size
        self.diagonal = np.zeros((frames, size, size))
        """Each frame's own block."""
        self.next = np.zeros((max(frames - 1, 0), size, size))
        """Block t couples frame t (rows) to frame t + 1 (columns)."""
        self.after_next = np.zeros((max(frames - REACH, 0), size))
        """Row t is the diagonal of the block that couples frame t to frame t + 2."""

    def add(self, other: "BlockBanded") -> None:
        """Add a matrix of the same shape."""
        self.diagonal += other.diagonal
        self.next += other.next
        self.after_next += other.after_next

    def add_rows(self, jacobians: tuple[Array, ...]) -> None:
        """Add JᵀJ of whitened rows that touch one frame or two consecutive ones.

        Args:
            jacobians: One (R, m, n) array for each frame a row touches, n ≤ size (the leading unknowns of a
                frame); row r touches frames r and r + 1.
        """
        rows, n = len(jacobians[0]), jacobians[0].shape[-1]
        turned = [np.swapaxes(jacobian, -1, -2) for jacobian in jacobians]
        for offset, jacobian in enumerate(jacobians):
            self.diagonal[offset : offset + rows, :n, :n] += turned[offset] @ jacobian
        for left, right in zip(turned, jacobians[1:], strict=False):
            self.next[:rows, :n, :n] += left @ right

    def multiply(self, vector: Array) -> Array:
        """The product with a vector (F, size)."""
        result = (self.diagonal @ vector[..., None])[..., 0]
        result[:-1] += (self.next @ vector[1:, :, None])[..., 0]
        result[1:] += (vector[:-1, None] @ self.next)[:, 0]
        result[:-REACH] += self.after_next * vector[REACH:]
        result[REACH:] += self.after_next * vector[:-REACH]
        return np.asarray(result)

    def factorise(self) -> "Factor":
        """The Cholesky factorisation; LinAlgError where the matrix is not positive definite."""
        n = self.size
        # An even number of frames, the last perhaps not there, makes pairs for the covariance.
        band = np.zeros((self.frames + self.frames % 2, n, REACH * n + 1))  # (frame, column, row - column)
        band[self.frames :, :, 0] = 1.0
        row, column = np.tril_indices(n)
        band[: self.frames, column, row - column] = self.diagonal[:, row, column]
        row, column = np.indices((n, n))
        band[: len(self.next), column, n + row - column] = np.swapaxes(self.next, -1, -2)
        band[: len(self.after_next), :, REACH * n] = self.after_next
        lower = band.reshape(-1, REACH * n + 1).T
        factor = cholesky_banded(lower, overwrite_ab=True, lower=True, check_finite=False)
        return Factor(self.frames, self.size, factor)


@dataclass(frozen=True, eq=False)
class Factor:
    """A factorised `BlockBanded` matrix."""

    frames: int
    size: int
    lower: Array
    """(2 size + 1, padded frames * size) the lower factor by diagonals, as LAPACK keeps it."""

    def solve(self, vector: Array) -> Array:
        """The solution (F, size) for a right-hand side (F, size)."""
        right = np.zeros((self.lower.shape[1] // self.size, self.size))
        right[: self.frames] = vector
        solution = cho_solve_banded((self.lower, True), right.ravel(), overwrite_b=True, check_finite=False)
        return np.array(solution.reshape(-1, self.size)[: self.frames])

    def covariance_blocks(self) -> Array:
        """The diagonal blocks (F, size, size) of the inverse."""
        n = self.size
        pairs = self.lower.shape[1] // (2 * n)
        blocks = np.zeros((2 * pairs, n, n))
        below = np.zeros((2 * n, 2 * n))
        for g in reversed(range(pairs)):
            factor, coupling = self._pair(g)
            # With L of this pair, G = C L⁻¹ below it and Σ of what follows: L⁻ᵀ (1 + Gᵀ Σ G) L⁻¹.
            inverse = solve_triangular(factor, np.eye(2 * n), lower=True, check_finite=False)
            gain = coupling @ inverse
            covariance = inverse.T @ inverse + gain.T @ below @ gain
            below = 0.5 * (covariance + covariance.T)
            blocks[2 * g], blocks[2 * g + 1] = below[:n, :n], below[n:, n:]
        return np.array(blocks[: self.frames])

    def _pair(self, index: int) -> tuple[Array, Array]:
        """Of the factor: a pair's own block (2n, 2n), lower, and the one beneath it, upper triangular."""
        width = REACH * self.size
        columns = self.lower[:, index * width : (index + 1) * width]
        row, column = np.tril_indices(width)
        own = np.zeros((width, width))
        own[row, column] = columns[row - column, column]
        row, column = np.triu_indices(width)
        beneath = np.zeros((width, width))
        beneath[row, column] = columns[width + row - column, column]
        return own, beneath
