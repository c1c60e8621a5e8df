"""Notes on evidence that no plausible posture explains, one sentence each."""

from ..files.fields import listed
from ..take.take import Take
from .found_poses import FoundPoses

MOST_NAMED = 3
"""Largest number of frames that a note names, and of notes."""


def contradiction_notes(take: Take, found: FoundPoses) -> tuple[str, ...]:
    """Notes on markers and keypoints that contradict, those of the most frames first."""
    frames: dict[str, list[int]] = {}
    for index, names in sorted(found.contradictions.items()):
        for name in names:
            frames.setdefault(name, []).append(index + take.frame_start)
    markers = {marker.name for marker in take.markers}
    notes = []
    for name in sorted(frames, key=lambda name: (-len(frames[name]), name))[:MOST_NAMED]:
        kind = "marker" if name in markers else "keypoint"
        notes.append(
            f"frame {listed([str(frame) for frame in frames[name]], MOST_NAMED)}: no plausible pose "
            f"explains {kind} {name}"
        )
    return tuple(notes)
