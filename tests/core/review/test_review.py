"""What a person judges a motion by."""

from dataclasses import fields, replace

import numpy as np
import pytest
from _review import made_up_review
from _synthetic_take import write_synthetic_take
from keymark.core.estimate.reconstruct import METHODS, reconstruct
from keymark.core.progress import run
from keymark.core.review.review import Review, review
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take


def same(first: Review, second: Review) -> bool:
    """Whether two reviews hold the same, outlines to single precision."""
    for field in fields(Review):
        one, other = getattr(first, field.name), getattr(second, field.name)
        if not isinstance(one, np.ndarray):
            if one != other:
                return False
        elif not np.allclose(one, other, rtol=1e-6, atol=1e-6, equal_nan=True):
            return False
    return True


def test_a_review_comes_back_from_its_arrays() -> None:
    """Names, sizes and reasons too, and with nothing that would need pickling."""
    review = made_up_review()
    arrays = review.to_arrays()
    assert all(array.dtype != object for array in arrays.values())
    again = Review.from_arrays(arrays)
    assert same(again, review)
    assert again.weak_frames == review.weak_frames
    assert again.marker_names == review.marker_names and again.size == (160, 120)


def test_a_review_without_weak_frames_comes_back() -> None:
    """Empty lists keep their kind."""
    arrays = {
        name: value for name, value in made_up_review().to_arrays().items() if not name.startswith("weak")
    }
    empty = {
        name: value[:0] for name, value in made_up_review().to_arrays().items() if name.startswith("weak")
    }
    assert Review.from_arrays({**arrays, **empty}).weak_frames == ()


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """A small synthetic take."""
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("take"), frames=24, keyframe_every=8))


@pytest.mark.parametrize("method", METHODS)
def test_a_reconstruction_of_every_method_can_be_reviewed(take: Take, method: str) -> None:
    """What was seen lies where it is predicted; only a method with uncertainty is believed in numbers."""
    result = run(reconstruct(take, method))
    seen = run(review(take, result, np.arange(24) + 1.0))
    assert seen.observed.shape[:2] == seen.predicted.shape[:2] == (24, 5)
    centers = [np.nanmean(outline, axis=2) for outline in (seen.observed, seen.predicted)]
    assert np.nanmedian(np.linalg.norm(centers[0] - centers[1], axis=-1)) < 3.0
    assert np.nanmedian(seen.reprojection_px) < 3.0
    assert seen.nearness[list(take.keyframe_indices)] == pytest.approx(1.0)
    known = method != "interpolation"
    assert np.isfinite(seen.confidence).all() == known and np.isfinite(seen.sigma_m).all() == known
    if known:
        assert seen.confidence[0] > seen.confidence[4] > 0.0
    assert same(Review.from_arrays(seen.to_arrays()), seen)


def test_the_motion_that_was_found_is_the_one_that_is_shown(take: Take) -> None:
    """The distance to the centroids is the estimate's own, and points lie where the camera sees them."""
    result = run(reconstruct(take))
    seen = run(review(take, result, np.arange(24) + 1.0))
    assert seen.reprojection_px == pytest.approx(result.motion.diagnostics["residual_px"], nan_ok=True)
    pixels, _ = result.model.camera.project(seen.points)
    assert seen.image_points == pytest.approx(pixels)


def test_few_keyframes_are_told_with_the_frames_that_lack_one(take: Take) -> None:
    """Between two keyframes at the ends, a frame in the middle is named."""
    few = replace(take, keyframes=(take.keyframes[0], take.keyframes[-1]))
    result = run(reconstruct(few, "interpolation"))
    worst = run(review(few, result, np.arange(24) + 1.0)).weak_frames[0]
    assert 6 <= worst.index <= 17
