"""Reviews of numbers that are made up."""

import numpy as np
from keymark.core.body.human import HUMAN
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
    )
