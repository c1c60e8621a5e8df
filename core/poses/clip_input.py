"""What of a take its poses are found from: evidence, the frames asked for, and what is posed."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import sole_heights_m
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..errors import InputError
from ..estimate.keypoint_trust import sided_by_pictures, upright
from ..numerics.vectors import runs
from ..prior.keyframe_proposals import evidence_speed, propose_keyframes
from ..prior.keyframes import Keyframe
from ..progress import run
from ..take.presence import SeenTake, within_shot
from ..take.take import Take
from .match_evidence import MatchEvidence


@dataclass(frozen=True, eq=False)
class PosedFrames:
    """K keyframes that a person posed, in order of time."""

    body: Body
    frames: IndexArray  # (K,) indices in the clip
    postures: tuple[Posture, ...]
    depth_found: BoolArray  # (K,) which of them a person vouches for in the picture only

    @classmethod
    def of(cls, body: Body, keyframes: Sequence[Keyframe]) -> "PosedFrames":
        """Those of some keyframes that a person has posed."""
        posed = sorted((each for each in keyframes if each.matched is None), key=lambda each: each.index)
        frames = np.array([each.index for each in posed], dtype=np.intp)
        depth_found = np.array([each.depth_found for each in posed], dtype=bool)
        return cls(body, frames, tuple(each.posture for each in posed), depth_found)

    @cached_property
    def hips(self) -> Array:
        """(K, 3) places of the hips [m]."""
        return np.array([posture.translation for posture in self.postures]).reshape(-1, 3)

    @cached_property
    def points(self) -> Array:
        """(K, P, 3) points relative to the hips [m]."""
        batch = Posture.stack(list(self.postures))
        return np.asarray(self.body.points(self.body.pose(batch)) - self.hips[:, None])

    def floor_m(self) -> float | None:
        """Height of the lowest sole [m]; None where nothing is posed in space."""
        if self.depth_found.all():
            return None
        batch = Posture.stack([self.postures[row] for row in np.flatnonzero(~self.depth_found)])
        return float(sole_heights_m(self.body, self.body.pose(batch)).min())


@dataclass(frozen=True, eq=False)
class PosingInput:
    """A clip, or some frames of it in a row, from which indices count."""

    body: Body
    camera: Camera
    evidence: MatchEvidence
    keyframes: IndexArray  # (K,) frames whose posture is asked for
    posed: PosedFrames
    keypoints: Keypoints  # all the performer's, in the detector's layout
    there: BoolArray  # (F,) frames in which the performer is there; others have no posture
    unseen: tuple[str, ...] = ()  # limbs that are never seen
    feet_seen: tuple[bool, bool] = (True, True)
    share: float = 1.0  # of the frames of the shot that is animated, in which the performer is there
    first: int = 0  # index of the first of these frames in the clip

    @cached_property
    def sampled(self) -> IndexArray:
        """(T,) the frames that are looked at: evenly spaced ones, the last, and those asked for or posed."""
        time_s = self.evidence.tracks.time_s
        duration = float(time_s[-1] - time_s[0]) / max(len(time_s) - 1, 1)
        # Rate at which a clip is sampled: between samples this near a motion's posture is well known.
        stride = max(1, round(1.0 / 15.0 / duration)) if duration > 0.0 else 1
        even = [np.append(np.arange(first, last, stride), last - 1) for first, last in runs(self.there)]
        every = np.concatenate([*even, self.keyframes, self.posed.frames])
        return np.unique(every).astype(np.intp)

    @cached_property
    def time_s(self) -> Array:
        """(T,) times of the frames that are looked at."""
        return self.evidence.tracks.time_s[self.sampled]


def tempering(time_s: Array) -> float:
    """Weight of each of several frames at some times (T,): what makes one doubtful makes its neighbors so."""
    # Time over which a performer differs from known postures in the same way: frames nearer count less
    # each.
    return min(1.0, float(np.median(np.diff(time_s))) / 0.25)


def posing_input(seen: SeenTake, keyframe_count: int | None = None) -> PosingInput:
    """Gather what a take has to find its poses by; pictures are not asked, nor what was found earlier.

    Frames to ask for are 10 per 100 where no count is given.

    Raises:
        InputError: No marker, no keypoint is seen.
    """
    take, tracks, keypoints, there = seen.take, seen.reading.tracks, seen.keypoints, seen.there
    check_followed(take)
    if not (tracks.visible.any() or keypoints.seen.any()):
        sources = (("marker", take.markers), ("keypoint", take.keypoints))
        missing = " and ".join(name for name, has in sources if has)
        raise InputError(f"{take.clip}: no {missing} is seen in the footage, so no posture can be found")
    keypoints = sided_by_pictures(keypoints, take.keypoints, take.body.actor.stature_m, tracks.time_s)
    speed = run(evidence_speed(tracks, take.marker_segments, keypoints)).values
    posed = [keyframe for keyframe in take.keyframes if there[keyframe.index]]
    return PosingInput(
        take.body,
        take.camera,
        MatchEvidence.of(tracks, take.marker_segments, upright(keypoints, take.camera)),
        _proposed(speed, there, keyframe_count),
        PosedFrames.of(take.body, posed),
        keypoints,
        there,
        seen.unseen,
        seen.feet_seen,
        float(there[within_shot(seen.reading)].mean()),
    )


def _proposed(speed: Array, there: BoolArray, count: int | None) -> IndexArray:
    """Frames to ask for, in each stretch in which the performer is there its share of `count`."""
    if there.all():
        return propose_keyframes(speed, count)
    chosen = []
    for first, last in runs(there):
        length, own = last - first, None
        if count is not None:
            own = min(max(round(count * length / int(there.sum())), 2), length)
        chosen.append(first + (propose_keyframes(speed[first:last], own) if length > 1 else np.zeros(1, int)))
    return np.concatenate(chosen).astype(np.intp)


def check_followed(take: Take) -> None:
    """Refuse a take that has neither markers nor keypoints by an InputError."""
    if not (take.markers or take.keypoints):
        raise InputError(
            f"{take.file}: the take has neither markers nor keypoints, without which no posture can be "
            "found; give it one of them, or pose its keyframes"
        )


def stretch_of(whole: PosingInput, first: int, last: int) -> PosingInput:
    """The frames from a first to a last one, both included."""
    own, posed = slice(first, last + 1), whole.posed
    rows = np.flatnonzero((posed.frames >= first) & (posed.frames <= last))
    frames = whole.keyframes
    inside = frames[(frames >= first) & (frames <= last) & ~np.isin(frames, posed.frames)]
    camera = whole.camera
    if camera.is_moving:
        camera = replace(camera, matrix_world=camera.matrix_world[own])
    return replace(
        whole,
        camera=camera,
        evidence=whole.evidence.frames(own),
        keyframes=inside - first,
        posed=replace(
            posed,
            frames=posed.frames[rows] - first,
            postures=tuple(posed.postures[row] for row in rows),
            depth_found=posed.depth_found[rows],
        ),
        keypoints=whole.keypoints.frames(own),
        there=np.ones(last + 1 - first, dtype=np.bool_),  # a person asks for them
        share=1.0,
        first=whole.first + first,
    )


# --- The part of a clip around a corrected keyframe whose found keyframes are posed anew


FARTHEST_S = 0.5
"""Time on either side of a corrected keyframe beyond which found ones stay: what a body does later
follows less and less from its posture there, and the animator waits."""


@dataclass(frozen=True)
class Section:
    """A part of a clip that is posed anew; all are indices of its frames."""

    first: int
    last: int
    changed: tuple[int, ...]  # found keyframes that are posed anew, in order


def section_around(time_s: Array, corrected: int, keyframes: Collection[Keyframe]) -> Section:
    """The part of a clip around a corrected keyframe that is posed anew.

    On either side it reaches to the next keyframe that the animator decided on, or else to the first found
    one beyond `FARTHEST_S`, or else to the clip's end; but always beyond one found keyframe, and nowhere
    without one. `corrected` is the keyframe's index.
    """
    ends, changed = [], []
    for side, end in ((-1, 0), (1, len(time_s) - 1)):
        outward = sorted(
            (each for each in keyframes if side * (each.index - corrected) > 0),
            key=lambda each: abs(each.index - corrected),
        )
        near: list[int] = []
        for each in outward:
            far = abs(float(time_s[each.index] - time_s[corrected])) > FARTHEST_S
            if each.matched is None or (far and near):
                end = each.index
                break
            near.append(each.index)
        ends.append(end if near else corrected)
        changed += near
    return Section(ends[0], ends[1], tuple(sorted(changed)))


def take_around(take: Take, section: Section) -> Take:
    """The take with all keyframes that hold: decided ones, and found ones that bound the section."""
    kept = []
    for keyframe in take.keyframes:
        bounds = keyframe.index in (section.first, section.last) and keyframe.index not in section.changed
        if keyframe.matched is None or bounds:
            found = keyframe.matched is not None or keyframe.depth_found
            kept.append(replace(keyframe, matched=None, depth_found=found))
    return replace(take, keyframes=tuple(kept))
