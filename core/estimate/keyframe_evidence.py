"""Calibration on the keyframes: placement of the markers, lens, and the size of the posing error.

All follow from the same residuals between the regions seen and those predicted, so they are found together:
the size of the posing error is that of the largest marginal likelihood over placements and lens (empirical
Bayes; Robbins 1956; MacKay 1992, *Bayesian Interpolation*), and placements and lens are the most probable
ones given that size. Regions that fit none count for less (Student's t), and a marker that never fits is
distrusted in all frames.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass, fields, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..camera.camera import Camera
from ..numerics.robust import DEGREES, student_weight
from ..terms.keypoints import ObservedKeypoints
from ..terms.region_model import MarkerPlacement, RegionModel
from ..terms.regions import FEATURES, NOISE, ObservedRegions, feature_rows, missing_variance
from .belief import FEWEST_POSED, POINT_STD_M, Belief, picture_information, posing_covariance
from .clip_problem import KeyframeEvidence, uncalibrated
from .keyframe_rows import LENS_DIFFERENCE, UNUSED, EvidenceRows, KeyframeRows
from .keypoint_evidence import KeypointEvidence, KnownKeypoints, keypoint_rows, learned_std, read_depths
from .windows import evenly_spread

# --- Placement of the markers, and the limbs' girth


PARAMETERS = tuple(field.name for field in fields(MarkerPlacement) if field.name != "segment")
PRIOR_STD = np.array([0.08, 0.08, 0.012, 0.012, 0.20])  # first, last, lateral [m], sagittal [m], girth
DIFFERENCE = np.array([1e-3, 1e-3, 1e-4, 1e-4, 1e-3])
SMALLEST = np.array([-0.3, 0.3, -0.06, -0.06, 0.5])
LARGEST = np.array([0.7, 1.3, 0.06, 0.06, 2.0])


@dataclass(frozen=True, eq=False)
class KnownFrames:
    """Frames whose posture is known, and the regions seen there."""

    pose: Pose  # forward kinematics of K postures
    frame: IndexArray  # (K,) their indices in the clip
    observed: ObservedRegions  # regions of those K frames


def placement_values(placements: tuple[MarkerPlacement, ...]) -> Array:
    """The parameters (M, P) of M placements, in the order of `PARAMETERS`."""
    values = [[getattr(placement, name) for name in PARAMETERS] for placement in placements]
    return np.array(values).reshape(len(placements), len(PARAMETERS))


def placements_from(start: tuple[MarkerPlacement, ...], values: Array) -> tuple[MarkerPlacement, ...]:
    """Placements on the segments of `start` with other parameters (M, P)."""
    return tuple(
        MarkerPlacement(placement.segment, *(float(v) for v in row))
        for placement, row in zip(start, values, strict=True)
    )


def placement_jacobian(body: Body, camera: Camera, known: KnownFrames, model: RegionModel) -> Array:
    """Jacobian of the residuals of `feature_rows` by each marker's own parameters, (K, M, 5, P).

    All differences are evaluated at once, as if each marker were worn several times.
    """
    start, values = model.placements, placement_values(model.placements)
    variants = np.concatenate([values[None], values + np.diag(DIFFERENCE)[:, None]])  # (1 + P, M, P)
    worn = tuple(placement for row in variants for placement in placements_from(start, row))
    predicted = RegionModel(body, camera, worn).evaluate(known.pose, known.frame)
    again = np.tile(np.arange(len(start)), len(variants))
    rows, _ = feature_rows(known.observed[:, again], predicted)
    rows = rows.reshape(len(rows), len(variants), len(start), -1)
    return np.asarray((np.moveaxis(rows[:, 1:], 1, -1) - rows[:, 0, ..., None]) / DIFFERENCE)


# --- Calibration


LEAST_TRUSTED = 0.3  # least visibility and quality of a region that judges a keyframe
USUAL_SIZE = 0.7  # log-normal prior of the size
SCALES = np.geomspace(0.1, 2.5, 17)  # sizes of the posing error tried, relative to a person's usual one


ContourReader = Callable[[Posture, IndexArray], EvidenceRows]  # rows at postures in given frames


@dataclass(frozen=True, eq=False)
class SeenAtKeyframes:
    """K keyframes, and what was seen there."""

    frame: IndexArray  # (K,) their indices in the clip
    posture: Posture  # the K postures
    observed: ObservedRegions  # the markers' regions
    width_px: Array  # (K, M) half-width of each marker's limb [px]
    keypoints: KeypointEvidence  # usual evidence of the N keypoints
    points: ObservedKeypoints  # those seen
    contours: ContourReader | None = None  # reads rows at some keyframes; None where contours judge none

    def __getitem__(self, index: IndexArray) -> "SeenAtKeyframes":
        """Some of the keyframes."""
        return replace(
            self,
            frame=self.frame[index],
            posture=self.posture[index],
            observed=self.observed[index],
            width_px=self.width_px[index],
            points=self.points[index],
        )


def read_belief(
    model: RegionModel, at: SeenAtKeyframes, belief: Belief
) -> Generator[None, None, KeyframeEvidence]:
    """Calibrate on those keyframes of which a person vouches, and judge them; others stay as doubtful."""
    body, pictured = model.body, belief.pictured
    covariance = belief.covariance(body, model.camera)
    information, known = np.linalg.inv(covariance), np.flatnonzero(belief.calibrating)
    if len(known) < FEWEST_POSED:
        return replace(uncalibrated(model, at.keypoints), information=information)
    if pictured.any():
        more = picture_information(body, model.camera, belief.postures[pictured], belief.frame[pictured])
        covariance[pictured] = np.linalg.inv(information[pictured] + more)
        depth_m = np.where(pictured[:, None], np.nan, at.points.depth_m)
        at = replace(at, points=replace(at.points, depth_m=depth_m))  # found depths tell nothing of guesses
    evidence = yield from read_keyframes(model, at[known], covariance[known])
    information[belief.posed] /= evidence.posing_scale**2
    return replace(evidence, information=information)


def read_keyframes(
    model: RegionModel, at: SeenAtKeyframes, posing: Array | None = None
) -> Generator[None, None, KeyframeEvidence]:
    """Calibrate markers and keypoints on keyframes and judge the keyframes by them.

    `posing` (K, D, D): their usual errors; None for those of keyframes posed in space.
    """
    posture, frame, keypoints, contours = at.posture, at.frame, at.keypoints, at.contours
    posing = posing_covariance(model.body, model.body.pose(posture)) if posing is None else posing
    believed = at.points.only(keypoints.trust > 0.0)
    if not model.placements and not believed.seen.any() and contours is None:
        information = np.linalg.inv(posing) / USUAL_SIZE**2
        return replace(uncalibrated(model, keypoints), posing_scale=USUAL_SIZE, information=information)
    judged = evenly_spread(frame)
    pose = model.body.pose(posture[judged])
    known = KnownFrames(pose, frame[judged], at.observed[judged])
    # (J, M, 5); without the slow bias, which at the keyframes is mostly the placements'.
    variance = NOISE.pixel_std_px**2 + NOISE.surface_std(at.width_px[judged]) ** 2
    calibrated, groups = model, [FEATURES] * len(model.placements)
    seen_points = None
    if believed.seen.any():
        seen_points = KnownKeypoints(pose, frame[judged], believed[judged])
        groups += [2] * len(keypoints.model.names)
    outlines = None if contours is None else contours(posture[judged], frame[judged])
    if outlines is not None:
        groups += [1] * outlines.residual.shape[1]
    usual, placed, std_m = keypoints.model, keypoints.model, keypoints.std_m
    size = np.array(groups)
    weight = np.ones((len(judged), int(size.sum())))
    markers = len(model.placements)
    distrust = np.ones(markers)
    scale = USUAL_SIZE
    for iteration in range(4):
        yield
        parts, area_ratio = [], np.ones(0)
        if markers:
            regions, area_ratio = _region_rows(calibrated, model, known, variance)
            parts.append(regions)
        if seen_points is not None:
            parts.append(keypoint_rows(placed, usual, seen_points, std_m))
        if outlines is not None:
            parts.append(outlines)
        seen = KeyframeRows.stacked(parts, posing[judged])
        yield
        if iteration > 0:  # before, a careless keyframe looks like a marker mistaken for another thing
            judging, tied = _judging(markers, keypoints, seen_points is not None, outlines)
            scale = yield from _most_likely_size(seen.part(judging, tied), weight[:, judging])
        change, left = seen.calibrated(weight, scale)
        squared = seen.squared(left, size, scale)
        usable = (seen.variance < UNUSED)[:, np.cumsum(size) - 1]
        ends = markers * len(PRIOR_STD)
        calibrated = _changed(model, np.append(change[:ends], change[-1]))
        if markers:
            distrust = _distrust(squared[:, :markers], usable[:, :markers])
        doubt = np.append(distrust, np.ones(len(size) - markers))
        trust = student_weight(squared / doubt**2, DEGREES, size) / doubt**2
        weight = np.repeat(trust, size, axis=1)
        if seen_points is not None:
            rows, places = 2 * len(usual.names), 3 * len(usual.names)
            placed = usual.changed(change[ends : ends + places].reshape(-1, 3), calibrated.camera)
            own = slice(markers * FEATURES, markers * FEATURES + rows)
            spread = seen.noise(weight, scale)[:, own, own]
            std_m = learned_std(placed, seen_points, keypoints.std_m, std_m, left[:, own], spread)
    if outlines is not None and not markers and seen_points is None:
        # 1.3: Factor of the posing error by contours alone: the colors that edges are found by are learned at
        # the same keyframes, with their errors, which hides about a quarter of these.
        scale *= 1.3
    information = np.linalg.inv(posing) / scale**2
    placed = replace(placed, camera=calibrated.camera)
    found_points = replace(keypoints, model=placed, std_m=std_m)
    if seen_points is not None and np.isfinite(at.points.depth_m).any():
        every = model.body.pose(posture)
        depths = read_depths(keypoints.depths, placed, every, frame, at.points.depth_m, scale * POINT_STD_M)
        found_points = replace(found_points, depths=depths)
    return KeyframeEvidence(calibrated, scale, distrust, area_ratio, information, found_points)


def _changed(model: RegionModel, change: Array) -> RegionModel:
    """A model with changed placements' parameters and logarithm of the focal length (X,)."""
    values = placement_values(model.placements)
    values = np.clip(values + change[:-1].reshape(values.shape), SMALLEST, LARGEST)
    camera = replace(model.camera, lens_mm=model.camera.lens_mm * float(np.exp(change[-1])))
    return RegionModel(model.body, camera, placements_from(model.placements, values))


def _region_rows(
    model: RegionModel, average: RegionModel, known: KnownFrames, variance: Array
) -> tuple[EvidenceRows, Array]:
    """Rows of the regions, and the area (M,) of each unhidden one relative to the predicted one."""
    predicted = model.evaluate(known.pose, known.frame, jacobian=True)
    residual, jacobian = feature_rows(known.observed, predicted)
    assert jacobian is not None
    parameter_jacobian = placement_jacobian(model.body, model.camera, known, model)
    nudge = np.zeros(parameter_jacobian.shape[1] * parameter_jacobian.shape[-1] + 1)
    nudge[-1] = LENS_DIFFERENCE
    zoomed, _ = feature_rows(known.observed, _changed(model, nudge).evaluate(known.pose, known.frame))
    by_lens = (zoomed - residual) / LENS_DIFFERENCE
    change = placement_values(average.placements) - placement_values(model.placements)
    lens_change = np.log(average.camera.lens_mm / model.camera.lens_mm)
    residual = residual + (parameter_jacobian @ change[..., None])[..., 0] + by_lens * lens_change
    usable = (
        np.isfinite(residual).all(-1)
        & (predicted.visible > LEAST_TRUSTED)
        & (known.observed.quality > LEAST_TRUSTED)
    )
    ratio = np.where(usable, known.observed.area / np.maximum(predicted.area, 1.0), np.nan)
    ratio = np.where(np.isfinite(ratio).any(axis=0), ratio, 1.0)  # of markers never seen
    area_ratio = np.asarray(np.nanpercentile(ratio, 75.0, axis=0))
    variance = variance + missing_variance(known.observed.area, area_ratio, predicted)
    prior = np.diag(np.tile(PRIOR_STD, usable.shape[1]) ** -2)
    rows = EvidenceRows.apart(usable, residual, parameter_jacobian, by_lens, jacobian, variance, prior)
    return rows, area_ratio


def _judging(
    markers: int, keypoints: KeypointEvidence, used: bool, outlines: EvidenceRows | None
) -> tuple[BoolArray, BoolArray]:
    """Which rows (R,) judge keyframes, with their parameters (X,): markers, contours, joints' keypoints.

    The others, of face, hands and feet, err along with these.
    """
    rows, parameters = np.ones(markers * FEATURES, bool), np.ones(markers * len(PRIOR_STD), bool)
    if used:
        points = np.array([name in HUMAN.point_names for name in keypoints.model.names])
        points |= not points.any()
        rows = np.concatenate([rows, np.repeat(points, 2)])
        parameters = np.concatenate([parameters, np.repeat(points, 3)])
    if outlines is not None:
        rows = np.append(rows, np.ones(outlines.residual.shape[1], bool))
        parameters = np.append(parameters, np.ones(outlines.by_parameters.shape[2], bool))
    return rows, np.append(parameters, True)


def _most_likely_size(seen: KeyframeRows, weight: Array) -> Generator[None, None, float]:
    """Mean over the posterior of the posing error's size, the fitted parameters integrated out.

    Woodbury's identity spares the dense matrix of all rows.
    """
    # The belief in the size is log-normal, its logarithm spread by 1.2.
    logarithm = -0.5 * (np.log(SCALES / USUAL_SIZE) / 1.2) ** 2
    for row, scale in enumerate(SCALES):
        noise = seen.noise(weight, scale)
        inverse, information, right = seen.gathered(noise)
        misfit = np.einsum("jr,jrs,js->", seen.residual, inverse, seen.residual)
        rest = misfit - right @ np.linalg.solve(information, right)
        spread = np.linalg.slogdet(noise)[1].sum() + np.linalg.slogdet(information)[1]
        logarithm[row] -= 0.5 * (rest + spread)
        yield
    probability = np.exp(logarithm - logarithm.max())
    return float(np.exp(probability @ np.log(SCALES) / probability.sum()))


def _distrust(squared: Array, usable: BoolArray) -> Array:
    """(M,) factors: each marker's median misfit relative to the expected one, or to the others' if larger."""
    # The median of χ² with n degrees of freedom is close to n (1 - 2 / 9n)³.
    usual = FEATURES * (1.0 - 2.0 / (9.0 * FEATURES)) ** 3
    ratio = np.ones(squared.shape[1])
    for marker, (values, used) in enumerate(zip(squared.T, usable.T, strict=True)):
        if used.any():
            ratio[marker] = np.sqrt(np.median(values[used]) / usual)
    # However far off, a marker keeps a hundredth of its weight.
    return np.asarray(np.clip(ratio / max(1.0, float(np.median(ratio))), 1.0, 10.0))
