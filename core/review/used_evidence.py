"""Evidence that a reconstruction rests on beside its keyframes."""

from ..estimate.reconstruct import Reconstruction
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
        reconstruction.keypoints.has_hints,
        solution.contours is not None,
    )


def _used_keypoints(reconstruction: Reconstruction) -> tuple[UsedKeypoints, ...]:
    """The sources of keypoints, in their order."""
    compared = compare_keypoints(reconstruction)
    seen = reconstruction.keypoints.seen
    used = []
    for source in dict.fromkeys(compared.sources):
        own = [index for index, other in enumerate(compared.sources) if other == source]
        count = int(seen[:, own].sum())
        believed = 1.0 - float((seen & compared.thrown_out)[:, own].sum()) / max(count, 1)
        names = tuple(dict.fromkeys(compared.names[index] for index in own))
        used.append(UsedKeypoints(source, names, believed if count else 0.0))
    return tuple(used)
