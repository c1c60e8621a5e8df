"""Symmetric systems in which each frame meets only its two neighbors on either side.

LAPACK's band Cholesky factorization solves them. A backward recursion over the factor's frames gives the
diagonal blocks of the inverse (the Rauch-Tung-Striebel smoother in information form; Särkkä 2013, *Bayesian
Filtering and Smoothing*, ch. 8; Takahashi, Fagan & Chen 1973 for the selected inverse). Time and memory grow
linearly with the clip.
"""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import as_strided
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.linalg.lapack import dtrtri

from ..arrays import Array

REACH = 2  # a frame is coupled to at most this many frames after it


class BlockBanded:
    """A symmetric positive definite matrix of F x F blocks.

    Neighboring frames couple all their unknowns; frames two apart couple like unknowns only, as second
    differences do, which keeps the band narrow.
    """

    def __init__(self, frames: int, size: int) -> None:
        """An all-zero matrix of `frames` blocks of `size` rows."""
        self.frames, self.size = frames, size
        self.diagonal = np.zeros((frames, size, size))  # each frame's own block
        self.next = np.zeros((max(frames - 1, 0), size, size))
        """Block t couples frame t (rows) to frame t + 1 (columns)."""
        self.after_next = np.zeros((max(frames - REACH, 0), size))
        """Row t is the diagonal of the block that couples frame t to frame t + 2."""

    def add(self, other: "BlockBanded") -> None:
        """Add a matrix of the same shape."""
        self.diagonal += other.diagonal
        self.next += other.next
        self.after_next += other.after_next

    def add_rows(self, jacobians: tuple[Array, ...], first: int = 0) -> None:
        """Add JᵀJ of whitened rows that touch one frame or two consecutive ones.

        One (R, m, n) array for each frame a row touches, about its leading n unknowns; row r touches frames
        `first` + r and `first` + r + 1.
        """
        rows, n = len(jacobians[0]), jacobians[0].shape[-1]
        turned = [np.swapaxes(jacobian, -1, -2) for jacobian in jacobians]
        for start, (across, jacobian) in enumerate(zip(turned, jacobians, strict=True), first):
            self.diagonal[start : start + rows, :n, :n] += across @ jacobian
        for left, right in zip(turned, jacobians[1:], strict=False):
            self.next[first : first + rows, :n, :n] += left @ right

    def add_combination(
        self, columns: slice, coefficients: tuple[Array | float, ...], information: Array
    ) -> None:
        """Add independent rows, each a combination of one unknown over consecutive frames: Σ_k c_k x[t + k].

        `coefficients`: c_k of at most three frames, each a number or (R, 1) or (R, n) for n columns;
        `information`: inverse variance, broadcastable to (R, n), R = F - K.
        """
        index = np.arange(self.size)[columns]
        rows = self.frames - len(coefficients) + 1
        if rows <= 0:
            return
        shape = (rows, len(index))
        weight = np.broadcast_to(information, shape)
        parts = [np.broadcast_to(c, shape) for c in coefficients]
        for first, left in enumerate(parts):
            touched = slice(first, first + rows)
            self.diagonal[touched, index, index] += weight * left**2
            if first + 1 < len(parts):
                self.next[touched, index, index] += weight * left * parts[first + 1]
            if first + REACH < len(parts):
                self.after_next[touched, columns] += weight * left * parts[first + REACH]

    def multiply(self, vector: Array) -> Array:
        """The product with a vector (F, size)."""
        result = (self.diagonal @ vector[..., None])[..., 0]
        result[:-1] += (self.next @ vector[1:, :, None])[..., 0]
        result[1:] += (vector[:-1, None] @ self.next)[:, 0]
        result[:-REACH] += self.after_next * vector[REACH:]
        result[REACH:] += self.after_next * vector[:-REACH]
        return np.asarray(result)

    def factorize(self) -> "Factor":
        """The Cholesky factorization; LinAlgError where the matrix is not positive definite."""
        n = self.size
        width = REACH * n
        band = np.zeros((self.frames, n, width + 1))  # (frame, column, row - column)
        for column in range(n):
            band[:, column, : n - column] = self.diagonal[:, column, column:]
            band[: len(self.next), column, n - column : width - column] = self.next[:, column]
        band[: len(self.after_next), :, width] = self.after_next
        lower = band.reshape(-1, width + 1).T
        factor = cholesky_banded(lower, overwrite_ab=True, lower=True, check_finite=False)
        return Factor(self.frames, self.size, factor)


@dataclass(frozen=True, eq=False)
class Factor:
    """A factorized `BlockBanded` matrix."""

    frames: int
    size: int
    lower: Array  # (2 size + 1, frames * size) the lower factor by diagonals, as LAPACK keeps it

    def solve(self, vector: Array) -> Array:
        """The solution (F, size, ...) for a right-hand side (F, size, ...)."""
        flat = vector.reshape(self.frames * self.size, *vector.shape[2:])
        solution = cho_solve_banded((self.lower, True), flat, check_finite=False)
        return np.asarray(solution.reshape(vector.shape))

    def covariance_blocks(self) -> Array:
        """The diagonal blocks (F, size, size) of the inverse."""
        n = self.size
        blocks = np.empty((self.frames, n, n))
        after = np.zeros((REACH * n, REACH * n))
        for t in reversed(range(self.frames)):
            own, beneath = self._column(t)
            # With L this frame's block, G = C L⁻¹ beneath it and Σ of the two frames after it, their joint
            # covariance has the blocks L⁻ᵀ L⁻¹ + Gᵀ Σ G, -Σ G and Σ.
            inverse, _ = dtrtri(own, lower=1)
            gain = beneath @ inverse
            spread = after @ gain
            covariance = inverse.T @ inverse + gain.T @ spread
            blocks[t] = 0.5 * (covariance + covariance.T)
            across = -spread[:n]
            after[n:, n:] = after[:n, :n]
            after[:n, :n], after[:n, n:], after[n:, :n] = blocks[t], across.T, across
        return blocks

    def _column(self, frame: int) -> tuple[Array, Array]:
        """A frame's own block of the factor (n, n), lower, and the two beneath it (2n, n)."""
        n = self.size
        kept = self.lower.T[frame * n : (frame + 1) * n]
        # Entry (row, column) lies `row - column` after the column's diagonal: a view with slanting columns.
        step, entry = kept.strides
        slanting = as_strided(kept, (n, (1 + REACH) * n), (step - entry, entry), writeable=False)
        below = np.arange((1 + REACH) * n) - np.arange(n)[:, None]
        rows = np.where((below >= 0) & (below <= REACH * n), slanting, 0.0).T
        return rows[:n], rows[n:]
