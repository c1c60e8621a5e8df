"""All poses of a clip in one go: the likeliest postures where nobody has posed, shared by every caller.

Postures are composed of the libraries' parts (`compose_clip`), then held against the footage by the estimate
that reconstructs motions, with the composed postures for its keyframes (`estimate/whole_clip`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..errors import InputError
from ..estimate.ankle_height import found_ankle_m
from ..estimate.whole_clip import Believed, Seen, estimate_whole_clip
from ..footage.reading import Reading
from ..library.library import Library
from ..matching.candidates import MatchedFrame
from ..matching.library_match import sampled_frames, tempering
from ..matching.match_input import MatchInput, match_input
from ..prior.interpolation import interpolate
from ..prior.keyframes import Keyframe
from ..progress import Job, Progress, stretch, within
from ..take.performer_keypoints import performer_keypoints
from ..take.take import Take
from ..text import Sentence
from .compose_clip import Composition, compose_frames
from .composed_candidates import composed_candidates
from .explained import contradicting, explained_shares
from .found_poses import FoundPoses
from .part_features import HEADINGS, StanceFeatures, stance_features
from .part_pools import PartPools, part_pools
from .posing_input import PosingInput, placed_in_clip, stretch_of
from .second_reading import is_better, read_again

COMPOSED_SHARE, FITTED_SHARE = 0.8, 0.98
"""Shares of the work after which postures are composed, and fitted to the footage."""


def pose_clip(
    take: Take,
    reading: Reading,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    keyframe_count: int | None = None,
    between: tuple[int, int] | None = None,
    frames: Sequence[int] | None = None,
) -> Job[FoundPoses]:
    """Find the postures of a clip that nobody posed.

    Args:
        take: The take; what is posed of it holds, what was found of it earlier is not used.
        reading: The clip as `read_footage` has read it.
        libraries: What is known of postures: each limb may come from another one.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: Number of frames to find keyframes at; 10 per 100 frames where None.
        between: First and last frame of the clip to look at; those of the two that are posed hold. The whole
            clip where None.
        frames: Indices of the frames to find keyframes at, instead of `keyframe_count` proposed ones.

    Yields:
        Progress.

    Returns:
        The postures; there always are some, with a confidence that says how far to trust them. Between two
        frames only those are found anew; elsewhere the postures are those of the take's keyframes.

    Raises:
        InputError: There is no library, none has a posture, or neither a marker nor a keypoint is seen.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to find poses")
    with threadpool_limits(limits=1, user_api="blas"):
        given = match_input(take, reading, keyframe_count)
        yield Progress("Learning the parts of postures", 0.0)
        search = _Search(take, usable, part_pools(usable, take.body), floor_m, between, frames)
        found = yield from stretch(search.poses(given, reading), 0.05, 1.0)
        again = None
        if between is None:
            again = yield from stretch(read_again(take, reading, found), 0.98, 0.98)
        if again is not None:
            repeated = search.poses(match_input(take, again, keyframe_count), again)
            second = yield from stretch(repeated, 0.05, 1.0)
            if is_better(second, found):
                found = replace(second, reading=again)
    yield Progress("Done", 1.0)
    return found


@dataclass(frozen=True, eq=False)
class _Search:
    """What is asked of a clip."""

    take: Take
    libraries: Sequence[Library]
    pools: PartPools
    floor_m: float | None
    between: tuple[int, int] | None
    frames: Sequence[int] | None

    def poses(self, given: MatchInput, reading: Reading) -> Job[FoundPoses]:
        """The postures by one reading of the clip."""
        take = self.take
        if self.frames is not None:
            given = replace(given, keyframes=np.unique(np.array(self.frames, dtype=np.intp)))
        floor_m = given.constraints.floor_m() if self.floor_m is None else self.floor_m
        work = PosingInput(given, performer_keypoints(take, None, reading.tracks))
        count = given.evidence.tracks.frame_count
        if self.between is not None:
            work = stretch_of(work, *self.between)
        given = work.given
        stances = stance_features(self.pools, given.evidence)
        sampled = sampled_frames(
            given.evidence.tracks, np.concatenate([given.keyframes, given.constraints.frames])
        )
        composing = compose_frames(given, self.pools, stances, sampled, floor_m)
        composed = yield from within("Composing postures", composing, 0.0, COMPOSED_SHARE)
        fitting = _fitted(take, work, sampled, composed)
        postures = yield from stretch(fitting, COMPOSED_SHARE, FITTED_SHARE)
        explained, off = explained_shares(given, sampled, postures[sampled])
        found = _candidates(self.pools, stances, work, sampled, composed, postures, explained)
        seen = np.isfinite(off).any(axis=1)
        fit = float(explained[seen].mean()) if seen.any() else 0.0
        if self.between is not None:
            ends = Keyframe(work.first, postures[0]), Keyframe(self.between[1], postures[-1])
            elsewhere = interpolate(take.keyframes or ends, count)
            postures = placed_in_clip(postures, elsewhere, work.first)
        return FoundPoses(
            found,
            postures,
            fit,
            composed.floor_m,
            Sentence("the found poses explain {fit:.0%} of the footage", fit=fit),
            _contradictions(take, work, sampled, off),
            between=self.between,
        )


def _fitted(take: Take, work: PosingInput, sampled: IndexArray, composed: Composition) -> Job[Posture]:
    """(F,) the composed postures held against the footage; posed frames stay."""
    given = work.given
    time_s = given.evidence.tracks.time_s[sampled]
    scale = np.full(len(sampled), 1.0 / np.sqrt(tempering(time_s)))  # neighbors err alike
    own = [composed.posture[row] for row in range(len(sampled))]
    for frame, posture in zip(given.constraints.frames, given.constraints.postures, strict=True):
        row = int(np.searchsorted(sampled, frame))
        own[row], scale[row] = posture, 0.0
    tracks = given.evidence.tracks
    keyframes = tuple(Keyframe(int(frame), posture) for frame, posture in zip(sampled, own, strict=True))
    fitting = estimate_whole_clip(
        given.body,
        given.camera,
        Seen(tracks, take.marker_segments, work.keypoints),
        Believed(
            interpolate(keyframes, tracks.frame_count),
            tuple(map(int, sampled)),
            scale,
            found_ankle_m(given.body, Posture.stack(own), sampled, tracks.frame_count, composed.floor_m),
        ),
    )
    return (yield from within("Fitting the postures", fitting, 0.0, 1.0)).posture


def _candidates(
    pools: PartPools,
    stances: StanceFeatures,
    work: PosingInput,
    sampled: IndexArray,
    composed: Composition,
    fitted: Posture,
    explained: Array,
) -> tuple[MatchedFrame, ...]:
    frames = []
    for row in map(int, np.searchsorted(sampled, work.given.keyframes)):
        index = int(sampled[row])
        torso = int(composed.path.stance[row]) // HEADINGS
        found = composed_candidates(
            pools,
            stances,
            composed.states[row],
            composed.path.posterior[row],
            index + work.first,
            fitted[index],
            torso,
            float(explained[row]),
        )
        frames.append(found)
    return tuple(frames)


def _contradictions(
    take: Take, work: PosingInput, sampled: IndexArray, off: Array
) -> Mapping[int, tuple[str, ...]]:
    """Names of what a proposed frame's posture does not explain, by its index in the clip."""
    markers = tuple(style.name for style in take.markers)
    names = (*markers, *work.given.evidence.keypoints.names)
    found = {}
    for row in map(int, np.searchsorted(sampled, work.given.keyframes)):
        wrong = tuple(names[column] for column in np.flatnonzero(contradicting(off[row])))
        if wrong:
            found[int(sampled[row]) + work.first] = wrong
    return found
