"""An actor's lengths from one frame in which the performer stands, the body height and two clicks.

The height between crown and ground fixes distance and place. What markers and keypoints show beyond that is
weighed against average proportions, which vary by four to five percent between people: maximum a posteriori
over posture, lengths and the markers' placements on their segments at once, with the height held. A sleeve
may begin anywhere on its segment, so a region's own extent says little of the segment's length; where the
regions lie to each other says more. Arms that point anywhere say nothing of their lengths; stretched
sideways, they do.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, IndexArray
from ..body.actor import Actor
from ..body.body_volume import ARMS_LOWERED_RAD, standing_height_m, standing_posture
from ..body.human import HUMAN
from ..body.kinematics import Body, Pose
from ..body.posture import Posture, facing_rad
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from ..markers.region_tracks import RegionTracks
from ..numerics.robust import DEGREES, student_cost, student_weight
from ..terms.keypoints import LEAST_CONFIDENCE, PIXEL_STD, USUAL_PLACES, KeypointModel, ObservedKeypoints
from ..terms.region_model import MarkerPlacement, RegionModel
from ..terms.regions import NOISE, ObservedRegions, feature_rows, limb_widths
from .keyframe_evidence import (
    LARGEST,
    PRIOR_STD,
    SMALLEST,
    KnownFrames,
    placement_jacobian,
    placement_values,
    placements_from,
)
from .performer_placement import ground_place
from .single_frame import is_misplaced_marker, is_misplaced_point

MEASURED = ("upper_arm", "forearm", "thigh", "shin", "shoulder_width", "hip_width", "trunk", "neck_head")
"""Lengths that are measured, left and right alike; hands and feet follow from the height."""
PROPORTION_STD = 0.045  # of the logarithm of a person's proportions about the average (Gordon et al. 2014)
LENGTH_DIFFERENCE = 1e-3
# Standard deviation of a standing person from the standing posture [m, rad]; arms may be anywhere.
STANDING_STD = {
    "pelvis.location": 0.04,
    "pelvis.rotation_z": 0.30,
    "pelvis": 0.06,
    "waist": 0.08,
    "neck": 0.15,
    "girdle": 0.10,
    "shoulder": 0.80,
    "elbow": 0.60,
    "forearm": 0.30,
    "hip": 0.10,
    "knee": 0.10,
    "shin": 0.05,
}
STRETCHED_STD = {"shoulder": 0.10, "elbow": 0.10}  # arms held out sideways as well as one can
UPRIGHT_PARTS = ("pelvis", "waist", "hip", "knee")
ARMS_RAISED_RAD = (0.0, 0.65, 1.3)  # starts of the descent: arms hanging, half raised and stretched out
TEMPERATURES = (64.0, 16.0, 4.0, 2.0, *(1.0 for _ in range(8)))


@dataclass(frozen=True, eq=False)
class MeasuredActor:
    """Lengths and place of a performer, measured from one frame."""

    body: Body
    posture: Posture  # a single posture: how the performer stands in that frame
    spread: dict[str, float]  # standard deviation of each of the lengths `MEASURED`, as a share of it
    stands: bool  # whether markers and keypoints fit someone who stands
    distance_m: float  # from the camera to the ground between the feet [m]


def measure_standing(
    camera: Camera,
    frame: int,
    stature_m: float,
    crown_px: ArrayLike,
    ground_px: ArrayLike,
    regions: RegionTracks | None = None,
    segments: tuple[str, ...] = (),
    arms_stretched: bool = False,
    keypoints: Keypoints | None = None,
) -> MeasuredActor:
    """Measure the lengths and the place of a performer who stands.

    `crown_px` and `ground_px` (2,) are the top of the head and the ground between the feet [px], `regions`
    and `keypoints` those of this frame alone; without both the lengths are average ones. `arms_stretched`:
    the arms are held out sideways, across the view.

    Raises:
        InputError: The height is out of range, or the two points cannot be a person's.
    """
    average = Actor.from_stature(stature_m)
    place = ground_place(camera, frame, stature_m, crown_px, ground_px)
    heading = facing_rad(camera.pose(frame)[0][:, 2])
    distance_m = float(np.linalg.norm(place - camera.pose(frame)[1]))
    keypoints = Keypoints.none(1) if keypoints is None else keypoints
    regions = RegionTracks.unmarked(np.zeros(1), camera.resolution) if regions is None else regions
    segments = segments if regions.names else ()
    if not (regions.visible.any() or keypoints.seen.any()):
        body = Body(average)
        unknown = dict.fromkeys(MEASURED, PROPORTION_STD)
        return MeasuredActor(body, standing_posture(body, place, heading), unknown, True, distance_m)
    problem = _Problem(
        camera,
        np.array([frame]),
        average,
        stature_m,
        place,
        distance_m,
        heading,
        ObservedRegions.from_tracks(regions),
        segments,
        ObservedKeypoints.of(keypoints),
        keypoints.names,
        arms_stretched,
    )
    found = [problem.descend(raised) for raised in ((0.0,) if arms_stretched else ARMS_RAISED_RAD)]
    return problem.measured(min(found, key=problem.cost))


@dataclass(frozen=True, eq=False)
class _Problem:
    """The estimation problem.

    Its unknowns x are a tangent step from the standing posture (D) [m, rad], the logarithms of the measured
    lengths relative to average ones, and the markers' placements relative to average ones (M * P).
    """

    camera: Camera
    frame: IndexArray
    average: Actor
    height_m: float
    place: Array
    distance_m: float
    heading: float
    observed: ObservedRegions
    segments: tuple[str, ...]
    points: ObservedKeypoints
    point_names: tuple[str, ...]  # (N,) the body points that the keypoints show
    arms_stretched: bool

    @cached_property
    def std(self) -> Array:
        """(X,) prior standard deviation of each unknown."""
        believed = {**STANDING_STD, **(STRETCHED_STD if self.arms_stretched else {})}
        groups = ["pelvis.location" if "location" in name else name.split(".")[0] for name in HUMAN.dof_names]
        steps = [
            believed.get(name, believed[group]) for name, group in zip(HUMAN.dof_names, groups, strict=True)
        ]
        markers = np.tile(PRIOR_STD, len(self.segments))
        return np.concatenate([steps, np.full(len(MEASURED), PROPORTION_STD), markers])

    def body(self, x: Array) -> Body:
        lengths = dict(self.average.segments_m)
        logarithms = x[HUMAN.dof_count : HUMAN.dof_count + len(MEASURED)]
        for name, logarithm in zip(MEASURED, logarithms, strict=True):
            for part in (name, *(f"{name}.{side}" for side in SIDES)):
                if part in lengths:
                    lengths[part] *= float(np.exp(logarithm))
        return Body(Actor(lengths))

    def posture(self, x: Array, body: Body) -> Posture:
        return Posture.stack([self.standing(body).plus(x[: HUMAN.dof_count])])

    def standing(self, body: Body) -> Posture:
        lowered = 0.0 if self.arms_stretched else ARMS_LOWERED_RAD
        return standing_posture(body, self.place, self.heading, lowered)

    def model(self, x: Array) -> RegionModel:
        average = tuple(MarkerPlacement.usual(segment) for segment in self.segments)
        if not average:
            return RegionModel(self.body(x), self.camera, ())
        change = x[HUMAN.dof_count + len(MEASURED) :].reshape(len(average), -1)
        values = np.clip(placement_values(average) + change, SMALLEST, LARGEST)
        return RegionModel(self.body(x), self.camera, placements_from(average, values))

    def keypoint_model(self, x: Array) -> KeypointModel:
        return KeypointModel.usual(self.body(x), self.camera, self.point_names)

    def descend(self, raised_rad: float) -> Array:
        """Gauss-Newton with annealed image noise from arms raised by so much."""
        std = self.std
        x = np.zeros(len(std))
        for side, out in zip(SIDES, (1.0, -1.0), strict=True):
            x[HUMAN.dof_names.index(f"shoulder.{side}.rotation_y")] = -out * raised_rad
        for temperature in TEMPERATURES:
            normal, gradient = self._equations(x, temperature)
            step = -np.linalg.solve(normal, gradient)
            x = x + step * min(1.0, 0.4 / max(float(np.abs(step).max()), 1e-12))
        return x

    def cost(self, x: Array) -> float:
        groups, height = self._rows(x)
        image = 0.0
        for residual, information in groups:
            squared = (residual**2 * information).sum(-1)
            image += student_cost(squared, DEGREES, residual.shape[-1]).sum()
        return float(image + 0.5 * ((x / self.std) ** 2).sum() + 0.5 * height**2)

    def measured(self, x: Array) -> MeasuredActor:
        normal, _ = self._equations(x, 1.0)
        found = slice(HUMAN.dof_count, HUMAN.dof_count + len(MEASURED))
        shares = np.sqrt(np.diag(np.linalg.inv(normal)[found, found]))
        body = self.body(x)
        exact = self.height_m / standing_height_m(body)
        body = Body(Actor({name: exact * length for name, length in body.actor.segments_m.items()}))
        spread = dict(zip(MEASURED, map(float, shares), strict=True))
        return MeasuredActor(body, self.posture(x, body)[0], spread, self._stands(x), self.distance_m)

    def _stands(self, x: Array) -> bool:
        model = self.model(x)
        predicted = model.evaluate(self._pose(x, model.body), self.frame)
        apart = np.linalg.norm(predicted.centroid - self.observed.centroid, axis=-1)
        width = limb_widths(model, self.posture(x, model.body).translation, self.frame)
        off_px = np.linalg.norm(self._off_px(x)[0], axis=-1)
        misplaced = is_misplaced_point(off_px, self._scale, self.points.confidence[0])
        upright = [name.split(".")[0] in UPRIGHT_PARTS for name in HUMAN.dof_names]
        deviations = np.abs(x / self.std)[: HUMAN.dof_count][np.array(upright)]
        return not (is_misplaced_marker(apart, width).any() or misplaced.any()) and bool(
            deviations.max() <= 3.0
        )

    def _off_px(self, x: Array) -> tuple[Array, Array]:
        """Differences (N, 2) of predicted and seen keypoints [px], and their variances (N,) [px²]."""
        model = self.keypoint_model(x)
        off = (model.pixels(self._pose(x, model.body), self.frame) - self.points.pixel)[0]
        places = [USUAL_PLACES[name] for name in self.point_names]
        std_m = np.array([np.hypot(place.place_std_m, place.error_std_m) for place in places])
        sure = np.maximum(self.points.confidence[0], LEAST_CONFIDENCE)
        return off, (self._scale * std_m / sure) ** 2 + PIXEL_STD**2

    @property
    def _scale(self) -> float:
        return float(self.camera.pixels_per_meter(self.camera.depth(self.place, int(self.frame[0]))))

    def _pose(self, x: Array, body: Body) -> Pose:
        return body.pose(self.posture(x, body))

    def _rows(self, x: Array) -> tuple[list[tuple[Array, Array]], float]:
        """Residuals [px] and information of regions (M, 5) and keypoints (N, 2), and the height's."""
        model = self.model(x)
        pose = self._pose(x, model.body)
        predicted = model.evaluate(pose, self.frame)
        residual, _ = feature_rows(self.observed, predicted)
        width = limb_widths(model, pose.posture.translation, self.frame)
        variance = NOISE.pixel_std_px**2 + NOISE.surface_std(width) ** 2
        usable = np.isfinite(residual).all(-1) & (predicted.visible > NOISE.least_visible)
        trust = np.where(usable, np.clip(self.observed.quality * predicted.visible, 1e-3, 1.0), 0.0)
        height = np.log(standing_height_m(model.body) / self.height_m) / 0.005
        off, spread = self._off_px(x)
        seen = np.isfinite(off).all(axis=-1)
        by_region = np.nan_to_num(residual[0]), (trust[..., None] / variance)[0]
        by_point = np.nan_to_num(off), np.where(seen, 1.0 / spread, 0.0)[:, None]
        return [by_region, by_point], float(height)

    def _equations(self, x: Array, temperature: float) -> tuple[Array, Array]:
        """Normal matrix (N, N) and gradient (N,)."""
        groups, height = self._rows(x)
        *by_x, height_by_x = self._jacobians(x, groups, height)
        normal, gradient = np.zeros((len(x), len(x))), np.zeros(len(x))
        for (residual, information), jacobian in zip(groups, by_x, strict=True):
            squared = (residual**2 * information / temperature).sum(-1)
            trust = student_weight(squared, DEGREES, residual.shape[-1])[:, None]
            weight = np.broadcast_to(information / temperature * trust, residual.shape)
            flat = jacobian.reshape(-1, len(x))
            normal += (flat.T * weight.ravel()) @ flat
            gradient += flat.T @ (weight * residual).ravel()
        normal += np.diag(self.std**-2.0)
        normal += np.outer(height_by_x, height_by_x)
        return normal, gradient + x / self.std**2 + height_by_x * height

    def _jacobians(
        self, x: Array, groups: list[tuple[Array, Array]], height: float
    ) -> tuple[Array, Array, Array]:
        """Jacobians of the regions' rows (M, 5, X), the keypoints' (N, 2, X) and the height (X,)."""
        model, points = self.model(x), self.keypoint_model(x)
        pose = self._pose(x, model.body)
        predicted = model.evaluate(pose, self.frame, jacobian=True)
        _, jacobian = feature_rows(self.observed, predicted)
        assert jacobian is not None
        by_region, by_point = (np.zeros((*residual.shape, len(x))) for residual, _ in groups)
        by_height = np.zeros(len(x))
        dofs = HUMAN.dof_count
        turned = self.standing(model.body).plus_jacobian(x[:dofs])
        by_region[..., :dofs] = jacobian[0] @ turned
        if self.point_names:
            by_point[..., :dofs] = points.pixels_jacobian(pose, self.frame)[0] @ turned
        for column in range(dofs, dofs + len(MEASURED)):
            nudged = x.copy()
            nudged[column] += LENGTH_DIFFERENCE
            others, other_height = self._rows(nudged)
            for by, (own, _), (other, _) in zip((by_region, by_point), groups, others, strict=True):
                by[..., column] = (other - own) / LENGTH_DIFFERENCE
            by_height[column] = (other_height - height) / LENGTH_DIFFERENCE
        if self.segments:
            known = KnownFrames(pose, self.frame, self.observed)
            by_place = placement_jacobian(model.body, self.camera, known, model)[0]  # (M, 5, P)
            for marker in range(len(by_place)):
                first = dofs + len(MEASURED) + marker * by_place.shape[-1]
                by_region[marker, :, first : first + by_place.shape[-1]] = by_place[marker]
        return np.nan_to_num(by_region), np.nan_to_num(by_point), by_height
