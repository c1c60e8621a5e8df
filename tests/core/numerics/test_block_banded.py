"""The block-banded solver against dense linear algebra."""

import numpy as np
import pytest
from keymark.core.numerics.block_banded import BlockBanded

SIZE = 4


def random_system(frames: int, seed: int) -> tuple[BlockBanded, np.ndarray]:
    """A positive definite system from random rows and weighted second differences, and the same dense."""
    rng = np.random.default_rng(seed)
    banded = BlockBanded(frames, SIZE)
    rows = max(frames - 2, 0)
    coefficients = [rng.normal(size=(rows, SIZE)) for _ in range(3)]
    banded.add_combination(slice(0, SIZE), tuple(coefficients), np.ones(SIZE))
    dense = np.zeros((frames * SIZE, frames * SIZE))
    for t in range(rows):
        wide = np.hstack([np.diag(part[t]) for part in coefficients])
        dense[t * SIZE : (t + 3) * SIZE, t * SIZE : (t + 3) * SIZE] += wide.T @ wide
    for reach in range(min(2, frames)):
        rows = frames - reach
        jacobians = tuple(rng.normal(size=(rows, 6, SIZE)) for _ in range(reach + 1))
        banded.add_rows(jacobians)
        for t in range(rows):
            wide = np.hstack([jacobian[t] for jacobian in jacobians])
            touched = slice(t * SIZE, (t + reach + 1) * SIZE)
            dense[touched, touched] += wide.T @ wide
    return banded, dense


@pytest.mark.parametrize("frames", [1, 2, 3, 6, 7])
def test_products_solutions_and_covariances_equal_the_dense_ones(frames: int) -> None:
    banded, dense = random_system(frames, seed=frames)
    vector = np.random.default_rng(9).normal(size=(frames, SIZE))
    np.testing.assert_allclose(banded.multiply(vector).ravel(), dense @ vector.ravel(), atol=1e-10)
    factor = banded.factorize()
    np.testing.assert_allclose(
        factor.solve(vector).ravel(), np.linalg.solve(dense, vector.ravel()), atol=1e-10
    )
    inverse = np.linalg.inv(dense)
    for t, block in enumerate(factor.covariance_blocks()):
        part = slice(t * SIZE, (t + 1) * SIZE)
        np.testing.assert_allclose(block, inverse[part, part], atol=1e-10)


def test_rows_about_the_leading_unknowns_leave_the_others_alone() -> None:
    banded = BlockBanded(2, SIZE)
    banded.add_rows((np.ones((2, 1, 2)),))
    assert banded.diagonal[:, :2, :2].sum() == 8.0
    assert banded.diagonal.sum() == 8.0


def test_a_singular_system_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        BlockBanded(3, SIZE).factorize()
