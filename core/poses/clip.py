"""All poses of a clip in one go: the likeliest postures where nobody has posed, shared by every caller.

Postures are composed of the libraries' parts (`compose_clip`), then held against the footage by the estimate
that reconstructs motions, with the composed postures for its keyframes (`estimate/whole_clip`).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from ..arrays import Array
from ..body.body_volume import rested
from ..body.posture import Posture
from ..estimate.belief import Belief
from ..estimate.clip_problem import Seen
from ..estimate.performer_placement import found_ankle_m
from ..estimate.whole_clip import WholeClipResult, estimate_whole_clip
from ..numerics.robust import DEGREES, student_weight
from ..prior.keyframes import Keyframe, interpolate
from ..prior.library import Library
from ..prior.texts import COMPOSED
from ..progress import Job, Part, Progress, stretch, within
from ..take.presence import SeenTake
from ..take.take import Take
from .agreement import agreement
from .clip_input import PosingInput, posing_input, stretch_of, tempering
from .compose_clip import Composition, compose_frames
from .found_poses import FoundPoses, MatchedFrame, composed_candidates
from .frame_likelihood import frame_likelihood
from .match_evidence import marker_moments
from .part_features import HEADINGS
from .part_pools import usable_libraries


def pose_clip(
    seen: SeenTake,
    libraries: Sequence[Library],
    floor_m: float | None = None,
    keyframe_count: int | None = None,
    between: tuple[int, int] | None = None,
    frames: Sequence[int] | None = None,
    floor_open: bool = False,
) -> Job[FoundPoses]:
    """Find the postures of a clip that nobody posed; there always are some, with a confidence.

    Args:
        seen: The take; what is posed of it holds, what was found of it earlier is not used.
        libraries: What is known of postures: each limb may come from another one.
        floor_m: Height of the floor in the world [m]; None where it is not known.
        keyframe_count: Number of frames to find keyframes at; 10 per 100 frames where None.
        between: First and last frame of the clip to look at; those of the two that are posed hold, and
            elsewhere the postures are those of the take's keyframes. The whole clip where None.
        frames: Indices of the frames to find keyframes at, instead of `keyframe_count` proposed ones.
        floor_open: An unknown floor is wherever the feet are; else it should be z = 0.

    Raises:
        InputError: There is no library, none has a posture, or neither a marker nor a keypoint is seen.
    """
    usable = usable_libraries(libraries)
    take = seen.take
    with threadpool_limits(limits=1, user_api="blas"):
        posing = posing_input(seen, keyframe_count)
        if frames is not None:
            posing = replace(posing, keyframes=np.unique(np.array(frames, dtype=np.intp)))
        floor_m = posing.posed.floor_m() if floor_m is None else floor_m
        count = posing.evidence.tracks.frame_count
        if between is not None:
            posing = stretch_of(posing, *between)
        yield Progress("Learning the parts of postures", 0.0)
        composing = compose_frames(posing, floor_m, usable, floor_open)
        composed = yield from within("Composing postures", composing, 0.05, 0.8)
        fitting = within("Fitting the postures", _fitting(take, posing, composed), 0.0, 1.0)
        result = yield from stretch(fitting, 0.8, 1.0)
        postures = rested(posing.body, result.posture, posing.unseen)
        explained, off = _explained(posing, postures[posing.sampled])
        candidates = _candidates(posing, composed, postures, explained)
        ground_m = 0.0 if floor_m is None and not floor_open else floor_m
        fit, reason = agreement(posing, postures, candidates, ground_m)
        if between is not None:
            ends = Keyframe(between[0], postures[0]), Keyframe(between[1], postures[-1])
            elsewhere = interpolate(take.keyframes or ends, count)
            rest = elsewhere[: between[0]], postures, elsewhere[between[1] + 1 :]
            postures = Posture.concatenate(list(rest))
    yield Progress("Done", 1.0)
    markers = tuple(style.name for style in take.markers)
    names = (*markers, *posing.evidence.keypoints.names)
    contradictions = {}
    for row in map(int, np.searchsorted(posing.sampled, posing.keyframes)):
        # Three deviations between performers are no longer explained.
        wrong = tuple(names[column] for column in np.flatnonzero(np.nan_to_num(off[row]) > 3.0))
        if wrong:
            contradictions[int(posing.sampled[row]) + posing.first] = wrong
    one = usable[0].identifier if len(usable) == 1 else COMPOSED
    return FoundPoses(
        candidates,
        postures,
        fit,
        composed.floor_m,
        reason,
        contradictions,
        one,
        between,
    )


def _fitting(take: Take, posing: PosingInput, composed: Composition) -> Part[WholeClipResult]:
    """The estimate that holds the composed postures against the footage; posed frames stay."""
    sampled = posing.sampled
    scale = np.full(len(sampled), 1.0 / np.sqrt(tempering(posing.time_s)))  # neighbors err alike
    own = [composed.posture[row] for row in range(len(sampled))]
    corrected = np.zeros(len(sampled), dtype=bool)
    posed = posing.posed
    for frame, posture, depth_found in zip(posed.frames, posed.postures, posed.depth_found, strict=True):
        row = int(np.searchsorted(sampled, frame))
        own[row], corrected[row] = posture, depth_found
        scale[row] = 1.0 if depth_found else 0.0
    tracks = posing.evidence.tracks
    keyframes = tuple(Keyframe(int(frame), posture) for frame, posture in zip(sampled, own, strict=True))
    return estimate_whole_clip(
        posing.body,
        posing.camera,
        Seen(tracks, take.marker_segments, posing.keypoints, there=posing.there),
        Belief(
            interpolate(keyframes, tracks.frame_count),
            sampled,
            scale,
            corrected,
            found_ankle_m(posing.body, Posture.stack(own), sampled, tracks.frame_count, composed.floor_m),
            posing.feet_seen,
        ),
        hold_rests=False,  # a held foot would pull on the postures around
    )


def _explained(posing: PosingInput, posture: Posture) -> tuple[Array, Array]:
    """How much postures (T,) of the frames that are looked at explain.

    Returns:
        (T,) mean weight under Student's t of the places of markers and keypoints, 0 where none is seen, and
        (T, A) how far each is off in standard deviations of performers' differences; NaN where not seen.
    """
    places = marker_moments(posing.body, posing.evidence, posture).centroid + posture.translation[:, None]
    shares, off = np.zeros(len(posing.sampled)), np.full(places.shape[:2], np.nan)
    for row, frame in enumerate(posing.sampled):
        seen = frame_likelihood(posing.camera, posing.evidence, int(frame))
        if seen.visible.any():
            residual = np.einsum("aki,ai->ak", seen.rows, places[row] - seen.location)
            off[row, seen.visible] = np.linalg.norm(residual, axis=-1)[seen.visible]
            shares[row] = student_weight(off[row, seen.visible] ** 2, DEGREES, 1).mean()
    return shares, off


def _candidates(
    posing: PosingInput, composed: Composition, fitted: Posture, explained: Array
) -> tuple[MatchedFrame, ...]:
    found = []
    for frame in posing.keyframes:
        row = int(np.searchsorted(posing.sampled, frame))
        own = composed_candidates(
            composed.stances,
            *composed.wanted[row],
            fitted[int(frame)],
            int(composed.stance[row]) // HEADINGS,
            float(explained[row]),
        )
        found.append(MatchedFrame(int(frame) + posing.first, own))
    return tuple(found)
