"""What a person judges a motion by."""

from dataclasses import fields

import numpy as np
from keymark.core.review import Reason, Review, WeakFrame

FRAMES, MARKERS = 6, 2


def made_up() -> Review:
    """A review of numbers without meaning, with gaps."""
    rng = np.random.default_rng(4)
    observed = rng.normal(size=(FRAMES, MARKERS, 8, 2))
    observed[2, 1] = np.nan
    return Review(
        frames=np.arange(FRAMES) + 1.5,
        size=(320, 240),
        marker_names=("trunk", "Ärmel"),
        point_names=tuple(f"point {i}" for i in range(13)),
        observed=observed,
        predicted=rng.normal(size=(FRAMES, MARKERS, 12, 2)),
        points=rng.normal(size=(FRAMES, 13, 3)),
        image_points=rng.normal(size=(FRAMES, 13, 2)),
        sigma_m=rng.uniform(size=(FRAMES, 13)),
        reprojection_px=rng.uniform(size=(FRAMES, MARKERS)),
        nearness=rng.uniform(size=FRAMES),
        speed=rng.uniform(size=FRAMES),
        confidence=rng.uniform(size=FRAMES),
        keyframe_indices=np.array([0, 5]),
        weak_frames=(WeakFrame(3, Reason.HIDDEN, 0.75, 1), WeakFrame(2, Reason.FAR, 0.25)),
    )


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
    review = made_up()
    arrays = review.to_arrays()
    assert all(array.dtype != object for array in arrays.values())
    again = Review.from_arrays(arrays)
    assert same(again, review)
    assert again.weak_frames == review.weak_frames
    assert again.marker_names == review.marker_names and again.size == (320, 240)


def test_a_review_without_weak_frames_comes_back() -> None:
    """Empty lists keep their kind."""
    arrays = {name: value for name, value in made_up().to_arrays().items() if not name.startswith("weak")}
    empty = {name: value[:0] for name, value in made_up().to_arrays().items() if name.startswith("weak")}
    assert Review.from_arrays({**arrays, **empty}).weak_frames == ()
