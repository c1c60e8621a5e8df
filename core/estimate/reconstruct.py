"""Reconstruction of a motion from a take: one generator shared by operator, command line and tests."""

from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from threadpoolctl import threadpool_limits

from ..arrays import Array, BoolArray, SingleArray, chunks
from ..body.body_volume import limb_dofs, rested
from ..body.human import ANKLES
from ..body.kinematics import Body
from ..body.posture import Posture
from ..detect.keypoints import Keypoints
from ..errors import InputError
from ..markers.reading import Reading
from ..markers.region_tracks import RegionTracks
from ..prior.keyframe_proposals import evidence_speed
from ..prior.keyframes import found_doubt, interpolate
from ..progress import Job, Progress, within
from ..take.motion import Motion
from ..take.presence import SeenTake, absence_notes, unseen_notes, within_shot
from ..take.read_footage import average_model, check_frame_count, check_in_front
from ..take.take import Take, check_method
from ..terms.region_model import RegionModel
from .belief import Belief
from .clip_problem import Seen
from .fuzzy import Memberships, keyframe_distance
from .kalman import filter_clip
from .keypoint_fit import KeypointFit, keypoint_notes, observed_joints
from .notes import contour_notes, evidence_notes, filter_notes, found_notes, marker_notes, of_true_causes
from .performer_placement import feet_over_floor_m, found_ankle_m
from .reference_evidence import KEYFRAME_WIDTH, NoReference, ReferenceEvidence, with_reference
from .sigma import (
    LIMB_STD_RAD,
    across_sight,
    guessed_depth_std_m,
    place_depth_std_m,
    undetermined_covariance,
    unobserved_variance,
)
from .whole_clip import WholeClipResult, estimate_whole_clip

CHUNK_FRAMES = 500


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """A motion and the intermediate results it was made from."""

    motion: Motion
    interpolation: Motion  # the keyframes interpolated without the footage, for comparison
    reading: Reading  # data read from the clip, for another reconstruction of it
    speed: Array  # (F,) V_sum of all evidence, with markers alone that of paper eq. 8 [px per frame]
    notes: tuple[str, ...]  # notes on the result for people, one sentence each
    keypoints: Keypoints  # the performer's keypoints in every frame, none where the take has none
    model: RegionModel  # the markers' region model: calibrated on the keyframes, or of average placements
    solution: WholeClipResult | None = None  # result of method `map`

    @property
    def keypoint_fit(self) -> KeypointFit | None:
        """How the keypoints agree with the motion, point by point; None without keypoints or `map`."""
        return self.solution.keypoints if self.solution is not None and self.keypoints.names else None


def reconstruct(
    seen: SeenTake,
    method: str = "map",
    referred: ReferenceEvidence | NoReference | None = None,
    floor_m: float | None = None,
    placed: bool = True,
) -> Job[Reconstruction]:
    """Reconstruct a take's motion.

    `method` is `map` (the whole clip at once), `ekf` (the paper's filter) or `interpolation`; `referred` is
    what the take's reference motion tells; `floor_m` is the floor's height, on which found poses should
    stand; `placed`: somebody says where the camera is, so that the performer's place can be wrong. Closing
    the generator cancels the job, which has no effects of its own.

    Raises:
        InputError: The method is unknown, or there are too few keyframes.
        ConversionError: No motion could be computed.
        ValueError: The reading is one of other markers.
    """
    check_reconstructible(seen.take, method)
    # The matrices are small: more threads of linear algebra take up to twenty times as long.
    with threadpool_limits(limits=1, user_api="blas"):
        return (yield from _reconstruct(seen, method, referred, floor_m, placed))


def check_reconstructible(take: Take, method: str) -> None:
    """Check method, keyframes and evidence, which do not depend on the clip.

    Raises:
        InputError: The method is unknown or needs markers that are not there, or keyframes are too few.
    """
    check_method(take, method)
    if len(take.keyframes) < 2 and (take.reference is None or method != "map"):
        raise InputError(f"{take.name} has {len(take.keyframes)} keyframes; at least 2 are needed")


def _reconstruct(
    shown: SeenTake,
    method: str,
    reference: ReferenceEvidence | NoReference | None,
    floor_m: float | None,
    placed: bool,
) -> Job[Reconstruction]:
    take, reading, keypoints, there = shown.take, shown.reading, shown.keypoints, shown.there
    notes, tracks, referred = take.notes, reading.tracks, None
    names = tuple(style.name for style in take.markers)
    if tracks.names != names:
        raise ValueError(f"the tracks are those of {tracks.names}, not of the take's markers {names}")
    check_frame_count(take, tracks.frame_count)
    check_in_front(take)
    if reference is not None:
        notes += reference.notes
        if isinstance(reference, ReferenceEvidence):
            referred, take = reference, with_reference(take, reference)
        elif len(take.keyframes) < 2:
            raise InputError(f"{reference.notes[0]}; without it at least 2 keyframes are needed")
    absent = absence_notes(take, there, within_shot(reading))
    take = _present(take, there)
    notes += reading.notes + shown.camera_notes + absent + found_notes(take) + keypoints.notes
    doubt = found_doubt(take.keyframes, take.fps)
    prior = interpolate(take.keyframes, tracks.frame_count)
    baseline = _motion(take, tracks, prior, None, "interpolation")
    motion, model, solution = baseline, average_model(take), None
    if method == "map":
        footage = Seen(tracks, take.marker_segments, keypoints, reading.album, there)
        belief = _belief(take, prior, doubt, shown.feet_seen, referred)
        estimate = estimate_whole_clip(take.body, take.camera, footage, belief)
        solution = yield from within("Estimating the motion", estimate, 0.0, 1.0)
        motion = _solved(take, shown, tracks, solution, doubt, floor_m, placed)
        model = solution.evidence.model
        notes += evidence_notes(take, solution.evidence)
        notes += keypoint_notes(solution.keypoints)
        notes += contour_notes(take, solution.contours is not None)
        notes += unseen_notes(shown.unseen, shown.unseen_ends)
    elif method == "ekf":
        motion = yield from _filtered(take, tracks, prior)
        notes += filter_notes(take)
    moved = evidence_speed(tracks, take.marker_segments, keypoints, reading.album)
    speed = yield from within("Measuring the speed", moved, 1.0, 1.0)
    yield Progress("Done", 1.0)
    notes += marker_notes(tracks, there)
    motion, baseline = motion.emptied(there), baseline.emptied(there)
    said = of_true_causes(notes)
    return Reconstruction(motion, baseline, reading, speed.values, said, keypoints, model, solution)


def _present(take: Take, there: BoolArray) -> Take:
    """The take with the keyframes of frames in which the performer is there."""
    kept = tuple(key for key in take.keyframes if there[key.index])
    if len(kept) < 2:
        raise InputError(
            f"{take.name} has {len(kept)} keyframes in frames that show somebody; at least 2 are needed"
        )
    return replace(take, keyframes=kept)


def _belief(
    take: Take,
    prior: Posture,
    doubt: Array,
    feet_seen: tuple[bool, bool],
    referred: ReferenceEvidence | None,
) -> Belief:
    """The belief in a take's keyframes; `doubt` (K,) as of `Belief`, but for wider reference motions."""
    ankle_m, frame = None, np.array(take.keyframe_indices, dtype=np.intp)
    if doubt.any():  # keyframes all of which are posed say where the floor is, and better
        ankle_m = found_ankle_m(take.body, prior[frame], frame, prior.batch[0])
    referring = [key.matched is not None and key.matched.is_referred for key in take.keyframes]
    doubt = doubt * np.where(referring, KEYFRAME_WIDTH, 1.0)
    pictured = np.array([keyframe.depth_found for keyframe in take.keyframes])
    expected = None if referred is None else referred.expected
    return Belief(prior, frame, doubt, pictured, ankle_m, feet_seen, expected)


def _solved(
    take: Take,
    shown: SeenTake,
    tracks: RegionTracks,
    result: WholeClipResult,
    doubt: Array,
    floor_m: float | None,
    placed: bool,
) -> Motion:
    fit, never = result.keypoints, shown.unseen
    diagnostics = {
        "residual_px": result.residual_px,
        "quality": tracks.quality,
        "posing_scale": np.array(result.evidence.posing_scale),
        "lens_mm": np.array(result.evidence.model.camera.lens_mm),
        "distrust": result.evidence.distrust,
    }
    if fit.keypoints.names:
        diagnostics |= {
            "keypoint_residual_px": fit.residual_px,
            "keypoint_weight": fit.weight,
            "keypoint_swapped": fit.swapped.astype(np.float64),
        }
    index = np.array(take.keyframe_indices, dtype=np.intp)
    points, seen = observed_joints(fit)
    if result.outlined is not None and result.contours is not None:
        points = (*points, *result.contours.model.parts.segments)
        seen = np.concatenate([seen, result.outlined], axis=1)
    visible = np.concatenate([tracks.visible, seen], axis=1)
    names = (*take.marker_segments, *points)
    known = [key.index for key in take.keyframes if key.matched is None or key.matched.is_referred]
    unseen = unobserved_variance(take.body.skeleton, names, visible, np.array(known, int), tracks.time_s)
    for limb in never:
        unseen[:, limb_dofs(take.body.skeleton, limb)] = LIMB_STD_RAD**2
    posture = rested(take.body, result.posture, never)
    motion = _motion(take, tracks, posture, result.covariance, "map", diagnostics, unseen)
    motion = replace(motion, unseen=never)
    if not doubt.any():
        return motion
    at_m, spread = motion.points, motion.point_covariance
    place_std_m: Array | float = 0.0
    if placed:
        lower = at_m[:, ANKLES, 2].min(axis=1) if any(shown.feet_seen) else None
        over_m = 0.0
        if lower is not None and floor_m is not None:
            over_m = feet_over_floor_m(take.body, at_m, floor_m)
        place_std_m = place_depth_std_m(at_m, lower, take.camera, over_m)
    # A reference motion has its own errors in the estimate; open is what all sizes share.
    found = [key.matched for key in take.keyframes]
    sure = np.array([1.0 if one is None or one.is_referred else one.confidence for one in found])
    guessed_m = None
    if not any(one is not None and one.is_referred for one in found):
        guessed_m = guessed_depth_std_m(at_m, take.camera, fit.keypoints)
    if guessed_m is not None:  # in place of what depths usually differ by
        own = point_covariance(take.body, posture, result.covariance)
        share = np.interp(np.arange(len(at_m)), index, doubt)
        spread = spread + across_sight(own, at_m, take.camera, share) - own
    spread = spread + undetermined_covariance(at_m, take.camera, index, doubt, sure, place_std_m, guessed_m)
    return replace(motion, point_covariance=spread)


def _filtered(take: Take, tracks: RegionTracks, prior: Posture) -> Job[Motion]:
    estimate = filter_clip(take.body, take.camera, tracks, take.marker_segments, prior, take.keyframe_indices)
    result = yield from within("Filtering the motion", estimate, 0.0, 1.0)
    diagnostics = {
        "normalized_innovation_squared": result.normalized_innovation_squared,
        "row_count": result.row_count.astype(np.float64),
        "gated": result.gated.astype(np.float64),
        "quality": tracks.quality,
    }
    return _motion(take, tracks, result.posture, result.covariance, "ekf", diagnostics)


def _motion(
    take: Take,
    tracks: RegionTracks,
    posture: Posture,
    covariance: Array | SingleArray | None,
    method: str,
    diagnostics: dict[str, Array] | None = None,
    unseen: Array | None = None,
) -> Motion:
    points = take.body.points(take.body.pose(posture))
    distance = keyframe_distance(tracks.frame_count, take.keyframe_indices)
    measures = {"nearness": Memberships().near(distance), **(diagnostics or {})}
    spread = np.full((*points.shape, 3), np.nan)
    if covariance is not None:
        spread = point_covariance(take.body, posture, covariance, unseen)
    return Motion(
        take.body,
        take.fps,
        take.frame_start,
        tracks.time_s,
        posture,
        points,
        spread,
        take.keyframe_indices,
        method,
        MappingProxyType(measures),
    )


def point_covariance(
    body: Body, posture: Posture, covariance: Array | SingleArray, more: Array | None = None
) -> Array:
    """Covariance (F, P, 3, 3) [m²] of the principal points from the posture's (F, D, D).

    `more` (F, D): variances added to it.
    """
    points = len(body.skeleton.points)
    spread = np.empty((len(covariance), points, 3, 3))
    for frame in chunks(np.arange(len(covariance)), CHUNK_FRAMES):
        jacobian = body.points_jacobian(body.pose(posture[frame]))  # (F, P, 3, D)
        across = np.swapaxes(jacobian, -1, -2)
        spread[frame] = jacobian @ covariance[frame, None] @ across
        if more is not None:
            spread[frame] += (jacobian * more[frame, None, None]) @ across
    return spread
