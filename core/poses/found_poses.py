"""Postures found in footage without posing, with the candidates of every proposed frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..body.posture import Posture
from ..errors import frames_in_words
from ..estimate.performer_placement import found_ankle_m, standing_ankle_m
from ..estimate.reference_evidence import ReferenceEvidence
from ..prior.keyframes import Keyframe, Matched, interpolate
from ..prior.texts import COMPOSED, REFERENCE
from ..take.take import Take
from .candidates import Candidate, MatchedFrame

NEAR_FRAMES = 2  # found keyframes keep farther than this from posed ones


@dataclass(frozen=True, eq=False)
class FoundPoses:
    """The most probable postures of a clip that nobody posed."""

    frames: tuple[MatchedFrame, ...]  # in order, those proposed for keyframes
    postures: Posture  # (F,) the posture in every frame of the clip
    fit: float  # probability that the motion is usable, 0 to 1, see `agreement`
    floor_m: float  # height of the floor that the performer stands on [m]
    reason: str  # sentence for people: whether it is usable, and what speaks for or against it
    contradictions: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    """Names of the markers and keypoints that no plausible posture explains, by index of a proposed frame."""
    library: str = COMPOSED  # identifier of the library that all was composed of, where only one was asked
    between: tuple[int, int] | None = None  # first and last frame that were looked at; None for all

    def keyframe(self, frame: MatchedFrame, index: int | None = None) -> Keyframe:
        """The found keyframe with a frame's chosen candidate, or at another index with the posture there."""
        chosen = frame.candidates[0]
        at = frame.index if index is None else index
        posture = chosen.posture if at == frame.index else self.postures[at]
        said = Matched(COMPOSED, chosen.name, chosen.mirrored, chosen.confidence)
        return Keyframe(at, posture, matched=said)

    def lowered(self, by_m: float) -> "FoundPoses":
        """The same in a world that is so much lower."""

        def lower(frame: MatchedFrame) -> MatchedFrame:
            candidates = (replace(each, posture=each.posture.lowered(by_m)) for each in frame.candidates)
            return replace(frame, candidates=tuple(candidates))

        frames, postures = tuple(map(lower, self.frames)), self.postures.lowered(by_m)
        return replace(self, frames=frames, postures=postures, floor_m=self.floor_m - by_m)

    def sought(self, index: int) -> bool:
        """Whether a frame was looked at."""
        return self.between is None or self.between[0] <= index <= self.between[1]


def with_found(take: Take, found: FoundPoses) -> Take:
    """The take with the found keyframes; posed ones stay, and found ones make room for them.

    Beside a posed keyframe a found one tells how the performer differs from the postures it was made of
    (`found_doubt`). Keyframes that were found earlier go, except where none was sought now.
    """
    posed = [key.index for key in take.keyframes if key.matched is None]
    kept = {key.index: key for key in take.keyframes if key.matched is None or not found.sought(key.index)}
    keyframes: dict[int, Keyframe] = {}
    for frame in found.frames:
        index = _free_frame(frame.index, posed, found.postures.batch[0])
        if index is not None and index not in keyframes:
            keyframes[index] = found.keyframe(frame, index)
    return replace(take, keyframes=tuple(each for _, each in sorted((keyframes | kept).items())))


def referred_poses(take: Take, said: ReferenceEvidence) -> FoundPoses:
    """The poses that a take has from its reference motion, among its keyframes already."""
    count = len(said.expected.points)
    postures = interpolate(take.keyframes, count)
    frames = tuple(
        MatchedFrame(key.index, (Candidate(key.posture, "", False, said.confidence),))
        for key in said.keyframes
    )
    every = np.arange(count)
    lower = found_ankle_m(take.body, postures, every, count)
    floor_m = float(np.min(lower)) - standing_ankle_m(take.body)
    reason = (
        f"the found poses are those of {said.name}, which fits the footage {said.gain:.0%} better than chance"
    )
    return FoundPoses(frames, postures, said.gain, floor_m, reason, library=REFERENCE)


def _free_frame(index: int, posed: Sequence[int], frames: int) -> int | None:
    """The frame itself or, near a posed keyframe, the nearest one that is far enough; None without one."""
    reach = range(-NEAR_FRAMES - 1, NEAR_FRAMES + 2)
    free = [
        index + step
        for step in sorted(reach, key=abs)
        if 0 <= index + step < frames and all(abs(index + step - other) > NEAR_FRAMES for other in posed)
    ]
    return free[0] if free else None


# --- Notes on evidence that no plausible posture explains, one sentence each


MOST_NAMED = 3  # largest number of frames that a note names, and of notes


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
        notes.append(f"{frames_in_words(frames[name], MOST_NAMED)}: no plausible pose explains {kind} {name}")
    return tuple(notes)
