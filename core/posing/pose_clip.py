"""All poses of a clip in one go: the likeliest postures where nobody has posed, shared by every caller."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from ..arrays import Array, IndexArray
from ..body.posture import Posture
from ..errors import InputError
from ..estimate.ankle_height import found_ankle_m
from ..estimate.whole_clip import estimate_whole_clip
from ..footage.reading import Reading
from ..library.library import Library
from ..matching.candidates import MatchedFrame
from ..matching.frame_likelihood import frame_likelihoods
from ..matching.library_match import sampled_frames
from ..matching.marker_moments import marker_moments
from ..matching.match_input import MatchInput, match_input
from ..matching.noise_scales import DEGREES_OF_FREEDOM
from ..prior.interpolation import interpolate
from ..prior.keyframes import Keyframe
from ..progress import Job, Progress, within
from ..take.performer_keypoints import performer_keypoints
from ..take.take import Take
from .compose_clip import Composition, compose_frames
from .composed_candidates import composed_candidates
from .found_poses import FoundPoses
from .part_features import HEADINGS, StanceFeatures, stance_features
from .part_pools import PartPools, part_pools

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
        between: First and last frame of the clip to look at, both posed; the whole clip where None.
        frames: Indices of the frames to find keyframes at, instead of `keyframe_count` proposed ones.

    Yields:
        Progress.

    Returns:
        The postures; there always are some, with a confidence that says how far to trust them.

    Raises:
        InputError: There is no library, none has a posture, or neither a marker nor a keypoint is seen.
    """
    usable = [library for library in libraries if library.postures]
    if not usable:
        raise InputError("no keyframe library with a posture is given; at least one is needed to find poses")
    with threadpool_limits(limits=1, user_api="blas"):
        given = match_input(take, reading, keyframe_count)
        if frames is not None:
            given = replace(given, keyframes=np.unique(np.array(frames, dtype=np.intp)))
        yield Progress("Learning the parts of postures", 0.0)
        pools = part_pools(usable, take.body)
        stances = stance_features(pools, given.evidence)
        tracks = given.evidence.tracks
        sampled = sampled_frames(tracks, np.concatenate([given.keyframes, given.constraints.frames]))
        if floor_m is None:
            floor_m = given.constraints.floor_m()
        composing = compose_frames(given, pools, stances, sampled, floor_m)
        found = yield from within("Composing postures", composing, 0.05, COMPOSED_SHARE)
        keyframes = tuple(
            Keyframe(int(frame), found.posture[row]) for row, frame in enumerate(map(int, sampled))
        )
        fitting = estimate_whole_clip(
            take.body,
            take.camera,
            tracks,
            take.marker_segments,
            interpolate(keyframes, tracks.frame_count),
            tuple(map(int, sampled)),
            match_scale=np.ones(len(sampled)),
            keypoints=performer_keypoints(take, None, reading.tracks),
            lower_ankle=found_ankle_m(take.body, found.posture, sampled, tracks.frame_count, found.floor_m),
        )
        fitted = yield from within("Fitting the postures", fitting, COMPOSED_SHARE, FITTED_SHARE)
    explained = _explained(given, sampled, fitted.posture)
    found_frames = _candidates(given, pools, stances, sampled, found, fitted.posture, explained)
    fit = float(explained.mean())
    yield Progress("Done", 1.0)
    return FoundPoses(found_frames, fitted.posture, fit, found.floor_m, _reason(found_frames, fit))


def _explained(given: MatchInput, sampled: IndexArray, posture: Posture) -> Array:
    """(T,) mean weight under Student's t of the places of markers and keypoints in sampled frames."""
    own = posture[sampled]
    places = marker_moments(given.body, given.evidence, own).centroid + own.translation[:, None]
    shares = np.ones(len(sampled))
    likelihoods = frame_likelihoods(given.camera, given.evidence, sampled, None, 1.0)
    for row, likelihood in enumerate(likelihoods):
        if not likelihood.visible.any():
            continue
        residual = np.einsum("aki,ai->ak", likelihood.image_axes, places[row] - likelihood.location)
        squared = ((residual * likelihood.weight[:, None]) ** 2).sum(axis=-1)
        shares[row] = float((1.0 / (1.0 + squared / DEGREES_OF_FREEDOM))[likelihood.visible].mean())
    return shares


def _candidates(
    given: MatchInput,
    pools: PartPools,
    stances: StanceFeatures,
    sampled: IndexArray,
    found: Composition,
    fitted: Posture,
    explained: Array,
) -> tuple[MatchedFrame, ...]:
    frames = []
    for row in map(int, np.searchsorted(sampled, given.keyframes)):
        index = int(sampled[row])
        torso = int(found.path.stance[row]) // HEADINGS
        frames.append(
            composed_candidates(
                pools,
                stances,
                found.states[row],
                found.path.posterior[row],
                index,
                fitted[index],
                torso,
                float(explained[row]),
            )
        )
    return tuple(frames)


def _reason(frames: Sequence[MatchedFrame], fit: float) -> str:
    """Sentence for people on how sure the postures are."""
    doubtful = sum(frame.candidates[0].confidence < 0.5 for frame in frames)
    said = "none is doubtful" if not doubtful else f"{doubtful} of {len(frames)} keyframes are doubtful"
    return f"the postures explain {fit:.0%} of the footage; {said}"
