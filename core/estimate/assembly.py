"""The terms of each estimate, in the order in which they are added.

A new kind of evidence is a file beside this one (the protocol is in `term.py`) and a line in each list it
belongs to: a window of a clip, the same once its contours are measured, a single frame. A list keeps its
order, since rounding depends on it.
"""

import numpy as np

from ..arrays import Array
from ..body.kinematics import Body
from ..numerics.block_banded import BlockBanded
from ..prior.frame_prior import REFERENCE_STEP_S, FramePrior
from ..terms.contact import BalanceTerm, FloorTerm, GroundTerm, StillnessTerm
from ..terms.depths import DepthHintTerm, DepthTerm, point_depths
from ..terms.keypoints import LEAST_CONFIDENCE, KeypointModel, KeypointTerm, ObservedKeypoints
from ..terms.motion import LimitTerm, SmoothnessTerm, belief_term
from ..terms.reference import ReferenceTerm
from ..terms.regions import ObservedRegions, RegionNoise, RegionTerm
from ..terms.state import ClipState
from ..terms.term import QuadraticTerm, Term
from .clip_problem import ClipProblem, KeyframeEvidence
from .keyframe_error import picture_std_m
from .keypoint_evidence import KeypointEvidence
from .performer_placement import ANKLE_HEIGHT_STD_M, SHOE_M, standing_ankle_m
from .windows import Window

ANKLES, LEGS = ("ankle.L", "ankle.R"), ("leg.L", "leg.R")
LOOSE_FEET = {"release_speed_m_s": 0.4, "release_height_m": 0.06}
"""Of feet that stand, where a reference motion, whose feet slide and jump, is followed from the start."""


def window_terms(clip: ClipProblem, window: Window, state: ClipState) -> list[Term]:
    """The terms of one window of a clip, but for its contours."""
    frames = window.frames
    step_s = clip.step_s[window.first : window.last - 1]
    pace = float(np.median(step_s)) / REFERENCE_STEP_S if len(step_s) else 1.0
    prior_depth = point_depths(clip.body, clip.camera, clip.body.pose(state.prior), state.frame)
    ankles = _seen_ankles(clip)
    evidence = clip.evidence
    terms: list[Term] = [
        _prior_term(clip, window, step_s),
        SmoothnessTerm(pace**1.5),
        RegionTerm(
            evidence.model,
            clip.observed[frames],
            clip.noise,
            clip.width_px[frames],
            evidence.distrust,
            evidence.area_ratio,
        ),
        DepthTerm(clip.camera, prior_depth, clip.depth_std_m[frames, None] * clip.depth_factor[frames]),
        LimitTerm(),
    ]
    if ankles:
        terms.append(stillness_term(clip, window))
    if evidence.keypoints.model.names:
        terms.append(_keypoint_term(clip, window, step_s))
    if np.isfinite(clip.points.depth_m).any():
        terms.append(_hint_term(clip, window, step_s))
    if clip.corrected.any():
        terms.append(_picture_term(clip, window))
    if clip.ankle_height_m is not None and ankles:
        terms.append(GroundTerm(ankles, clip.ankle_height_m[frames], ANKLE_HEIGHT_STD_M))
    if clip.reference is not None:
        kept = np.exp(-step_s / clip.reference.memory_s)[:, None]
        terms.append(ReferenceTerm(clip.reference[frames], kept))
    return terms


def stillness_term(clip: ClipProblem, window: Window) -> StillnessTerm:
    """Ankles of legs that are seen, and stand."""
    pairs = slice(window.first, window.last - 1)
    rests = None if clip.rests is None else clip.rests[pairs]
    loose = LOOSE_FEET if clip.reference is not None else {}
    return StillnessTerm(clip.camera, _seen_ankles(clip), clip.step_s[pairs], rests, **loose)


def _seen_ankles(clip: ClipProblem) -> tuple[int, ...]:
    seen = [leg not in clip.unseen for leg in LEGS]
    return tuple(ankle for ankle, own in zip(_ankles(clip.body), seen, strict=True) if own)


def frame_terms(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    belief: FramePrior,
    noise: RegionNoise,
    width_px: Array,
    points: ObservedKeypoints | None = None,
) -> list[Term]:
    """The terms of one frame, for as many states of it as the belief has starts, S.

    Regions (1, M), NaN where hidden, and keypoints (1, N) are those of this one frame.
    """
    model, starts = evidence.model, belief.starts.batch[0]
    bias_std = noise.bias_std(width_px).reshape(1, -1)
    repeated = observed[np.zeros(starts, dtype=np.intp)]
    width = np.repeat(width_px, starts, axis=0)
    terms: list[Term] = [
        belief_term(starts, belief.posture.skeleton.dof_count, bias_std),
        RegionTerm(model, repeated, noise, width, evidence.distrust, evidence.area_ratio),
        LimitTerm(),
    ]
    if belief.grounded is not None:
        ankles = _ankles(model.body)
        standing = model.body.points(model.body.pose(belief.grounded))
        terms.append(GroundTerm(ankles, float(standing[:, list(ankles), 2].min())))
    if points is not None and evidence.keypoints.model.names:
        terms += _frame_point_terms(evidence.keypoints, points, starts)
    return terms


def free_frame_terms(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    starts: int,
    floor_m: float | None,
    noise: RegionNoise,
    width_px: Array,
    points: ObservedKeypoints | None = None,
) -> tuple[Term, list[Term]]:
    """The terms of one frame of which nothing is believed but that a person stands before the camera.

    `starts`: number of states of it; `floor_m`: None where it is not known. The belief of each descent in its
    own start, and all else.
    """
    model, body = evidence.model, evidence.model.body
    bias_std = noise.bias_std(width_px).reshape(1, -1)
    repeated = observed[np.zeros(starts, dtype=np.intp)]
    width = np.repeat(width_px, starts, axis=0)
    terms: list[Term] = [
        RegionTerm(model, repeated, noise, width, evidence.distrust, evidence.area_ratio),
        LimitTerm(),
        BalanceTerm(body),
    ]
    if floor_m is not None:
        standing_m = floor_m + standing_ankle_m(body)
        terms += [GroundTerm(_ankles(body), standing_m), FloorTerm(_ankles(body), standing_m - SHOE_M)]
    if points is not None and evidence.keypoints.model.names:
        terms += _frame_point_terms(evidence.keypoints, points, starts)
    return belief_term(starts, body.skeleton.dof_count, bias_std), terms


def _frame_point_terms(evidence: KeypointEvidence, points: ObservedKeypoints, starts: int) -> list[Term]:
    """The keypoints of one frame, and the depths guessed with them, in as many states."""
    std_m = np.where(evidence.trust > 0.0, evidence.std_m, np.inf)
    repeated = points[np.zeros(starts, dtype=np.intp)]
    terms: list[Term] = [KeypointTerm(evidence.model, repeated, std_m, None)]
    if np.isfinite(points.depth_m).any():
        depths = evidence.depths
        std = _depth_std_m(evidence, points, depths.std_m)[0]
        expected = depths.expected(points.depth_m)[0]
        terms.append(DepthHintTerm(evidence.model, depths.links, expected, std, None))
    return terms


def _ankles(body: Body) -> tuple[int, ...]:
    return tuple(body.skeleton.point_names.index(name) for name in ANKLES)


def _keypoint_term(clip: ClipProblem, window: Window, step_s: Array) -> KeypointTerm:
    evidence = clip.evidence.keypoints
    kept = np.exp(-step_s / evidence.memory_s)[:, None]
    return KeypointTerm(evidence.model, clip.points[window.frames], evidence.error_m, kept)


def _picture_term(clip: ClipProblem, window: Window) -> KeypointTerm:
    """Points of keyframes that were put right in the picture."""
    model = KeypointModel.usual(clip.body, clip.camera, clip.body.skeleton.point_names)
    frame = clip.keyframes[clip.corrected]
    pixel = np.full((clip.frames, len(model.names), 2), np.nan)
    pixel[frame] = model.pixels(clip.body.pose(clip.prior[frame]), frame)
    seen = np.isfinite(pixel).all(axis=-1)
    observed = ObservedKeypoints(pixel, seen.astype(np.float64), np.full(seen.shape, np.nan))
    std_m = np.full(len(model.names), picture_std_m(clip.body))
    return KeypointTerm(model, observed[window.frames], std_m, None)


def _hint_term(clip: ClipProblem, window: Window, step_s: Array) -> DepthHintTerm:
    evidence, points = clip.evidence.keypoints, clip.points[window.frames]
    std_m = _depth_std_m(evidence, points, evidence.depths.error_m)
    kept = np.exp(-step_s / evidence.depths.memory_s)[:, None]
    expected = evidence.depths.expected(points.depth_m)
    return DepthHintTerm(evidence.model, evidence.depths.links, expected, std_m, kept)


def _depth_std_m(evidence: KeypointEvidence, points: ObservedKeypoints, error_m: Array) -> Array:
    """(F, L) errors of the links' guessed depths, of which `error_m` (L,) are those of sure detections."""
    links = evidence.depths.links
    sure = np.where(links.ends != 0.0, points.confidence[:, None], 1.0).min(axis=-1)
    left_out = (links.ends != 0.0) @ (evidence.trust == 0.0) > 0.0
    return np.asarray(np.where(left_out, np.inf, error_m) / np.maximum(sure, LEAST_CONFIDENCE))


def _prior_term(clip: ClipProblem, window: Window, step_s: Array) -> QuadraticTerm:
    """The deviation's size, trust in keyframes, and the biases' slow drift."""
    noise, width_px = clip.noise, clip.width_px[window.frames]
    inside = (clip.keyframes >= window.first) & (clip.keyframes < window.last)
    dofs, frames = clip.body.skeleton.dof_count, len(width_px)
    size = noise.bias_std(width_px).reshape(frames, -1)
    matrix = BlockBanded(frames, dofs + size.shape[1])
    posture, bias = slice(0, dofs), slice(dofs, None)
    matrix.add_combination(posture, (1.0,), np.array(20.0**-2))
    factor = clip.accelerations
    information = factor.T @ clip.evidence.information[inside] @ factor
    matrix.diagonal[clip.keyframes[inside] - window.first, :dofs, :dofs] += information
    kept = np.exp(-step_s / noise.bias_time_s)[:, None]
    matrix.add_combination(bias, (-kept, 1.0), (size[1:] * np.sqrt(1.0 - kept**2)) ** -2.0)
    matrix.diagonal[0, bias, bias] += np.diag(size[0] ** -2.0)
    return QuadraticTerm(matrix)
