"""Reviews of numbers that are made up."""

import numpy as np
from keymark.core.body.human import HUMAN
from keymark.core.review.compared_keypoints import ComparedKeypoints
from keymark.core.review.review import Reason, Review, WeakFrame


def made_up_review(frames: int = 13, first: float = 1.0) -> Review:
    """F frames of two markers: confidence falls towards the middle, one marker is hidden for some frames."""
    rng = np.random.default_rng(4)
    middle = np.sin(np.pi * np.arange(frames) / (frames - 1))
    observed = rng.normal(size=(frames, 2, 8, 2))
    reprojection = rng.uniform(size=(frames, 2))
    observed[2, 1], reprojection[2, 1], reprojection[3] = np.nan, np.nan, np.nan
    return Review(
        frames=np.arange(frames) + first,
        size=(160, 120),
        marker_names=("trunk", "Ärmel"),
        point_names=HUMAN.point_names,
        observed=observed,
        predicted=rng.normal(size=(frames, 2, 12, 2)),
        points=rng.normal(size=(frames, 13, 3)),
        image_points=rng.normal(size=(frames, 13, 2)),
        sigma_m=0.01 + 0.02 * middle[:, None] * rng.uniform(0.5, 1.0, size=(frames, 13)),
        reprojection_px=reprojection,
        nearness=1.0 - middle,
        speed=5.0 + 3.0 * middle,
        confidence=1.0 - 0.6 * middle,
        keyframe_indices=np.array([0, frames - 1]),
        weak_frames=(WeakFrame(frames // 2, Reason.HIDDEN, 1.0, 1), WeakFrame(3, Reason.FAR, 0.25)),
        contours=rng.uniform(20.0, 100.0, size=(frames, 6, 4, 2)),
        keypoints=made_up_keypoints(frames),
    )


def made_up_keypoints(frames: int = 13) -> ComparedKeypoints:
    """F frames of a wrist and a knee of one source, and the same wrist of another, a pixel from the motion.

    The first wrist is thrown out in frame 1, hidden in frame 2, and taken for the other one in frame 4.
    """
    seen = np.random.default_rng(5).uniform(20.0, 100.0, size=(frames, 3, 2))
    seen[2, 0] = np.nan
    predicted, thrown_out, swapped = seen + [1.0, 0.0], *np.zeros((2, frames, 3), dtype=bool)
    predicted[1, 0] += 30.0
    thrown_out[1, 0], swapped[4, 0] = True, True
    score = np.where(np.isfinite(seen[..., 0]), 0.9, 0.0)
    distance, expected = np.linalg.norm(seen - predicted, axis=-1), np.full((frames, 3), 2.0)
    names, sources = ("wrist.L", "knee.R", "wrist.L"), ("a detector", "a detector", "Blender's tracks")
    return ComparedKeypoints(names, sources, seen, predicted, score, distance, expected, thrown_out, swapped)
