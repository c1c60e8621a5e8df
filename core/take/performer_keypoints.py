"""The performer's keypoints: of all people seen in a take, those of the one whom the keyframes show."""

import numpy as np

from ..body.posture import Posture
from ..footage.keypoints.keypoints import Keypoints
from .take import Take


def performer_keypoints(take: Take, prior: Posture | None, frame_count: int | None = None) -> Keypoints:
    """The keypoints of the performer from all sources, side by side.

    Args:
        take: The take.
        prior: F postures, roughly where the performer is; None before there are keyframes.
        frame_count: F where there is no prior.
    """
    frames = prior.batch[0] if prior is not None else frame_count or 0
    parts = []
    for people in take.keypoints:
        if people.most_people > 1:
            raise NotImplementedError("several people")
        pixel = np.full((frames, len(people.names), 2), np.nan)
        score, hint = np.zeros(pixel.shape[:2]), np.full((*pixel.shape[:2], 3), np.nan)
        for index, seen in enumerate(people.frames[:frames]):
            if len(seen.pixel):
                pixel[index], score[index], hint[index] = seen.pixel[0], seen.score[0], seen.hint_m[0]
        parts.append(Keypoints(people.names, (people.source,) * len(people.names), pixel, score, hint))
    return Keypoints.side_by_side(parts, frames)
