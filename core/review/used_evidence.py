"""Evidence that a reconstruction rests on beside its keyframes."""

import numpy as np

from ..estimate.reconstruct import Reconstruction
from ..estimate.whole_clip import WholeClipResult
from ..take.used_evidence import UsedEvidence, UsedKeypoints
from .compare_keypoints import compare_keypoints


def used_evidence(reconstruction: Reconstruction) -> UsedEvidence:
    """What a motion was held against: all that a take has, but with the paper's filter its markers alone."""
    method, markers = reconstruction.motion.method, reconstruction.tracks.names
    solution = reconstruction.solution
    if method != "map" or solution is None:
        return UsedEvidence(markers if method == "ekf" else ())
    return UsedEvidence(
        markers,
        _used_keypoints(reconstruction),
        _uses_hints(solution),
        solution.contours is not None,
    )


def _uses_hints(solution: WholeClipResult) -> bool:
    """Whether any believed point has a guessed depth."""
    trusted = solution.evidence.keypoints.trust > 0.0
    return bool(np.isfinite(solution.problem.points.depth_m[:, trusted]).any())


def _used_keypoints(reconstruction: Reconstruction) -> tuple[UsedKeypoints, ...]:
    """The sources of keypoints, in their order."""
    compared = compare_keypoints(reconstruction)
    seen = np.isfinite(compared.seen).all(axis=-1)
    used = []
    for source in dict.fromkeys(compared.sources):
        own = [index for index, other in enumerate(compared.sources) if other == source]
        count = int(seen[:, own].sum())
        doubted, swapped = (
            float((seen & flags)[:, own].sum()) / max(count, 1)
            for flags in (compared.thrown_out, compared.swapped)
        )
        names = tuple(dict.fromkeys(compared.names[index] for index in own))
        used.append(UsedKeypoints(source, names, 1.0 - doubted if count else 0.0, swapped))
    return tuple(used)
