"""The terms of each estimate, in the order in which they are added.

A new kind of evidence is a file in `core/terms` (the protocol is in its `term.py`) and a line in each list it
belongs to: a window of a clip, the same once its contours are measured, a single frame. A list keeps its
order, since rounding depends on it.
"""

from collections.abc import Sequence
from itertools import compress

import numpy as np

from ..arrays import Array
from ..body.human import ANKLES
from ..body.kinematics import Body
from ..body.posture import Posture
from ..numerics.block_banded import BlockBanded
from ..prior.frame_prior import REFERENCE_STEP_S
from ..terms.contact import BalanceTerm, FloorTerm, GroundTerm, StillnessTerm
from ..terms.depths import DepthHintTerm, DepthTerm, point_depths
from ..terms.head import MEMORY_S, HeadTerm
from ..terms.keypoints import LEAST_CONFIDENCE, KeypointModel, KeypointTerm, ObservedKeypoints
from ..terms.motion import LimitTerm, SmoothnessTerm, belief_term
from ..terms.reference import ReferenceTerm
from ..terms.regions import NOISE, ObservedRegions, RegionTerm
from ..terms.term import ClipState, QuadraticTerm, Term
from .belief import picture_std_m
from .clip_problem import ClipData, ClipProblem, KeyframeEvidence
from .keypoint_evidence import KeypointEvidence
from .performer_placement import ANKLE_HEIGHT_STD_M, SHOE_M, standing_ankle_m
from .windows import Window

LOOSE_FEET = {"release_speed_m_s": 0.4, "release_height_m": 0.06}
"""Of feet that stand, where a reference motion, whose feet slide and jump, is followed from the start."""


def window_terms(clip: ClipProblem, window: Window, state: ClipState) -> list[Term]:
    """The terms of one window of a clip, but for its contours."""
    data, evidence, frames = clip.data, clip.evidence, window.frames
    belief, step_s, ankles = data.belief, data.step_s[window.first : window.last - 1], _seen_ankles(data)
    prior_depth = point_depths(data.body, data.camera, data.body.pose(state.prior), state.frame)
    depth_std_m = belief.depth_std_m[frames, None] * clip.depth_factor[frames]
    regions = evidence.model, data.observed[frames], data.width_px[frames]
    pace = float(np.median(step_s)) / REFERENCE_STEP_S if len(step_s) else 1.0
    terms: list[Term] = [
        _prior_term(clip, window, step_s),
        SmoothnessTerm(pace**1.5),
        RegionTerm(*regions, evidence.distrust, evidence.area_ratio),
        DepthTerm(data.camera, prior_depth, depth_std_m),
        LimitTerm(),
    ]
    if ankles:
        terms.append(stillness_term(clip, window))
    if evidence.keypoints.model.names:
        error_m, memory_s = evidence.keypoints.errors(belief.found_share[frames])
        kept = _kept(step_s, memory_s[1:])
        terms.append(KeypointTerm(evidence.keypoints.model, data.points[frames], error_m, kept))
    if np.isfinite(data.points.depth_m).any():
        points, hints = evidence.keypoints, evidence.keypoints.depths
        kept = _kept(step_s, hints.memory_s)
        terms.append(_hint_term(points, data.points[frames], hints.error_m, kept))
    if data.heads is not None:
        terms.append(HeadTerm(data.heads[frames], _kept(step_s, MEMORY_S)))
    if belief.pictured.any():
        terms.append(_picture_term(data, window))
    if belief.ankle_m is not None and ankles:
        terms.append(GroundTerm(ankles, belief.ankle_m[frames], ANKLE_HEIGHT_STD_M))
    if belief.reference is not None:
        terms.append(ReferenceTerm(belief.reference[frames], _kept(step_s, belief.reference.memory_s)))
    return terms


def stillness_term(clip: ClipProblem, window: Window) -> StillnessTerm:
    """Ankles of legs that are seen, and stand."""
    pairs = slice(window.first, window.last - 1)
    rests = None if clip.rests is None else clip.rests[pairs]
    loose = LOOSE_FEET if clip.data.belief.reference is not None else {}
    return StillnessTerm(clip.data.camera, _seen_ankles(clip.data), clip.data.step_s[pairs], rests, **loose)


def _kept(step_s: Array, memory_s: Array | float) -> Array:
    """(F - 1, 1) share of an error that is left in the next frame."""
    return np.exp(-step_s / memory_s)[:, None]


def _seen_ankles(data: ClipData) -> tuple[int, ...]:
    return tuple(compress(ANKLES, data.belief.feet_seen))


def frame_terms(
    evidence: KeyframeEvidence,
    observed: ObservedRegions,
    starts: int,
    width_px: Array,
    points: ObservedKeypoints,
    standing: Sequence[Term] = (),
) -> list[Term]:
    """The terms of one frame, for as many states of it as there are starts: first the belief in each start.

    Regions (1, M), NaN where hidden, and keypoints (1, N) are those of this one frame; `standing` is what
    is believed of feet and floor.
    """
    again, model = np.zeros(starts, dtype=np.intp), evidence.keypoints.model
    width = np.repeat(width_px, starts, axis=0)
    terms: list[Term] = [
        belief_term(starts, evidence.model.body.skeleton.dof_count, NOISE.bias_std(width_px).reshape(1, -1)),
        RegionTerm(evidence.model, observed[again], width, evidence.distrust, evidence.area_ratio),
        LimitTerm(),
        *standing,
    ]
    if model.names:
        std_m = np.where(evidence.keypoints.trust > 0.0, evidence.keypoints.std_m, np.inf)
        terms.append(KeypointTerm(model, points[again], std_m))
        if np.isfinite(points.depth_m).any():
            hints = evidence.keypoints.depths
            terms.append(_hint_term(evidence.keypoints, points[again], hints.std_m, None))
    return terms


def grounded_terms(body: Body, grounded: Posture | None) -> list[Term]:
    """Feet on the floor that a posture stands on, where one is believed to."""
    if grounded is None:
        return []
    ankles = body.points(body.pose(grounded))[:, list(ANKLES), 2]
    return [GroundTerm(ANKLES, float(ankles.min()))]


def upright_terms(body: Body, floor_m: float | None) -> list[Term]:
    """Somebody of whom nothing is believed but to stand; `floor_m`: None where it is not known."""
    if floor_m is None:
        return [BalanceTerm(body)]
    ankle_m = floor_m + standing_ankle_m(body)
    return [BalanceTerm(body), GroundTerm(ANKLES, ankle_m), FloorTerm(ANKLES, ankle_m - SHOE_M)]


def _picture_term(data: ClipData, window: Window) -> KeypointTerm:
    """Points of keyframes that were put right in the picture."""
    model = KeypointModel.usual(data.body, data.camera, data.body.skeleton.point_names)
    frame = data.belief.frame[data.belief.pictured]
    pixel = np.full((len(data.time_s), len(model.names), 2), np.nan)
    pixel[frame] = model.pixels(data.body.pose(data.belief.prior[frame]), frame)
    seen = np.isfinite(pixel).all(axis=-1)
    observed = ObservedKeypoints(pixel, seen.astype(np.float64), np.full(seen.shape, np.nan))
    std_m = np.full(len(model.names), picture_std_m(data.body))
    return KeypointTerm(model, observed[window.frames], std_m)


def _hint_term(
    evidence: KeypointEvidence, points: ObservedKeypoints, error_m: Array, kept: Array | None
) -> DepthHintTerm:
    """The links' guessed depths, of which `error_m` (L,) are the errors of sure detections."""
    links = evidence.depths.links
    sure = np.where(links.ends != 0.0, points.confidence[:, None], 1.0).min(axis=-1)
    left_out = (links.ends != 0.0) @ (evidence.trust == 0.0) > 0.0
    std_m = np.where(left_out, np.inf, error_m) / np.maximum(sure, LEAST_CONFIDENCE)
    return DepthHintTerm(evidence.model, links, evidence.depths.expected(points.depth_m), std_m, kept)


def _prior_term(clip: ClipProblem, window: Window, step_s: Array) -> QuadraticTerm:
    """The deviation's size, trust in keyframes, and the biases' slow drift."""
    width_px, keyframes = clip.data.width_px[window.frames], clip.data.belief.frame
    inside = (keyframes >= window.first) & (keyframes < window.last)
    dofs, frames = clip.data.body.skeleton.dof_count, len(width_px)
    size = NOISE.bias_std(width_px).reshape(frames, -1)
    matrix = BlockBanded(frames, dofs + size.shape[1])
    posture, bias = slice(0, dofs), slice(dofs, None)
    matrix.add_combination(posture, (1.0,), np.array(20.0**-2))
    factor = clip.accelerations
    information = factor.T @ clip.evidence.information[inside] @ factor
    matrix.diagonal[keyframes[inside] - window.first, :dofs, :dofs] += information
    kept = _kept(step_s, NOISE.bias_time_s)
    matrix.add_combination(bias, (-kept, 1.0), (size[1:] * np.sqrt(1.0 - kept**2)) ** -2.0)
    matrix.diagonal[0, bias, bias] += np.diag(size[0] ** -2.0)
    return QuadraticTerm(matrix)
