"""Measurement model of keypoints: points fixed to segments, seen in the image, with Jacobians.

A detector's shoulder or hip is not the joint's center, and a nose, a knuckle or a toe is no principal point
at all. So every point of the body has a usual place in the frame of one of the skeleton's joints, from which
a calibration departs. Hands and feet do not turn against forearm and shin in a posture; their points err by
what wrists and ankles really do.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import HEAD_OVERSHOOT, HEEL_BEHIND
from ..body.human import HUMAN, WAIST_HEIGHT
from ..body.kinematics import Body, Pose
from ..body.rotations import cross
from ..body.skeleton import SIDES, Placement
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints
from .term import ClipState, Rows, Term


@dataclass(frozen=True)
class UsualPlace:
    """Where a point of the body usually is, and by how much a detector's point differs from it."""

    joint: str  # the joint in whose frame it is fixed
    placement: Placement  # its place there, in shares of the actor's lengths
    place_std_m: float  # standard deviation, along each axis, of where detectors and performers have it [m]
    error_std_m: float  # usual error of a sure detection, along each axis of the image [m]


JOINT_PLACE_STD_M, WIDE_PLACE_STD_M = 0.02, 0.035
"""Of limbs' joints; and of hips, shoulders, head and trunk, which detectors define as they please [m]."""
JOINT_ERROR_STD_M = 0.02  # at most a fifth of a limb's length; also what annotators differ by
NECK_HEAD = "neck_head"
# Heights and breadths of the head over `neck_head`, from averages of adults (Gordon et al. 2014, as in
# `body_volume`): pupils level with the head's center and 32 mm off the middle, tragus 15 mm below it.
FACE: Mapping[str, tuple[float, float, float]] = {
    "nose": (0.0, -0.48, 0.88),
    "eye": (0.13, -0.36, 1.0),
    "ear": (0.32, 0.0, 0.94),
    "crown": (0.0, 0.0, HEAD_OVERSHOOT),
}
# Along the hand, toward the thumb and out of the palm's plane, in lengths of a hand, palms down and thumbs
# forward at rest.
HAND: Mapping[str, tuple[float, float, float]] = {
    "index": (0.48, -0.12, 0.0),
    "thumb": (0.27, -0.22, -0.08),
    "pinky": (0.42, 0.15, 0.0),
}
# Out, back and up in lengths from ankle to the tip of the toes; a foot rigid with an upright shin.
FOOT: Mapping[str, tuple[float, float, float]] = {
    "heel": (0.0, HEEL_BEHIND, -0.36),
    "toe": (0.0, -0.93, -0.36),
    "small_toe": (0.22, -0.75, -0.36),
}


def _usual_places() -> dict[str, UsualPlace]:
    joint = {point.name: HUMAN.joints[point.joint].name for point in HUMAN.points}
    wide = ("shoulder", "hip", "head")
    places = {
        point.name: UsualPlace(
            joint[point.name],
            point.placement,
            WIDE_PLACE_STD_M if point.name.split(".")[0] in wide else JOINT_PLACE_STD_M,
            JOINT_ERROR_STD_M,
        )
        for point in HUMAN.points
    }
    middle = {"trunk": (0.0, 0.0, 1.0 - WAIST_HEIGHT)}
    places["neck"] = UsualPlace("waist", middle, WIDE_PLACE_STD_M, JOINT_ERROR_STD_M)
    places["pelvis"] = UsualPlace("pelvis", {}, WIDE_PLACE_STD_M, JOINT_ERROR_STD_M)
    for name, (out, back, up) in FACE.items():
        for side, sign in (("", 0.0),) if out == 0.0 else ((".L", 1.0), (".R", -1.0)):
            placement: Placement = {NECK_HEAD: (sign * out, back, up)}
            places[name + side] = UsualPlace("neck", placement, JOINT_PLACE_STD_M, JOINT_ERROR_STD_M)
    for side in SIDES:
        sign = 1.0 if side == "L" else -1.0
        length = HUMAN_LENGTHS_M["hand"]
        for name, (along, back, up) in HAND.items():
            placement = {f"forearm.{side}": (sign, 0.0, 0.0), f"hand.{side}": (sign * along, back, up)}
            turned = 0.35 * length * along
            places[f"{name}.{side}"] = _at_an_extremity(f"forearm.{side}", placement, turned)
        length = HUMAN_LENGTHS_M["foot"]
        for name, (out, back, up) in FOOT.items():
            placement = {f"shin.{side}": (0.0, 0.0, -1.0), f"foot.{side}": (sign * out, back, up)}
            turned = 0.35 * length * float(np.hypot(back, up))
            places[f"{name}.{side}"] = _at_an_extremity(f"shin.{side}", placement, turned)
    return places


HUMAN_LENGTHS_M: Mapping[str, float] = {"hand": 0.19, "foot": 0.19}


def _at_an_extremity(joint: str, placement: Placement, turned_m: float) -> UsualPlace:
    error = float(np.hypot(JOINT_ERROR_STD_M, turned_m))
    return UsualPlace(joint, placement, JOINT_PLACE_STD_M, error)


USUAL_PLACES: Mapping[str, UsualPlace] = _usual_places()  # by the name of the body point


@dataclass(frozen=True, eq=False)
class KeypointModel:
    """Predicts where N named points of an actor are seen."""

    body: Body
    camera: Camera
    names: tuple[str, ...]  # (N,) the body points; the same one may occur several times
    place: Array  # (N, 3) where each sits in its joint's frame [m]

    @classmethod
    def usual(cls, body: Body, camera: Camera, names: tuple[str, ...]) -> "KeypointModel":
        """Points at their usual places."""
        places = [body.local(USUAL_PLACES[name].placement) for name in names]
        return cls(body, camera, names, np.array(places).reshape(len(names), 3))

    def changed(self, change: Array, camera: Camera) -> "KeypointModel":
        """The model with places moved by `change` (N, 3) [m], before another camera."""
        return replace(self, place=self.place + change, camera=camera)

    @cached_property
    def joint(self) -> IndexArray:
        """(N,) the joint that each point moves with."""
        index = [self.body.skeleton.joint_index(USUAL_PLACES[name].joint) for name in self.names]
        return np.array(index, dtype=np.intp)

    def world(self, pose: Pose) -> Array:
        """(F, N, 3) the points in space [m]."""
        turned = pose.rotation[:, self.joint] @ self.place[..., None]
        return np.asarray(pose.origin[:, self.joint] + turned[..., 0])

    def pixels(self, pose: Pose, frame: IndexArray) -> Array:
        """(F, N, 2) the points in the image [px], NaN behind the camera; `frame` (F,) as in the clip."""
        return self.camera.project(self.world(pose), frame[:, None])[0]

    def pixels_jacobian(self, pose: Pose, frame: IndexArray, factor: Array | None = None) -> Array:
        """(F, N, 2, D) derivative of the pixels by the posture's tangent [px per m or rad].

        `factor` (F, N) on each point's rows, zero for one that does not count; None for 1.
        """
        rows, world = self._rows(pose, frame)
        if factor is not None:
            rows = np.where(factor[..., None, None] > 0.0, rows * factor[..., None, None], 0.0)
        # Rows times v + ω × p are rows · v + (p × rows) · ω.
        wrench = np.concatenate([rows, cross(world[:, :, None], rows)], axis=-1)
        jacobian = (wrench.reshape(len(frame), -1, 6) @ pose.screws).reshape(*rows.shape[:3], -1)
        jacobian *= pose.posture.skeleton.moved_by[self.joint][:, None]
        return np.asarray(jacobian)

    def place_jacobian(self, pose: Pose, frame: IndexArray) -> Array:
        """(F, N, 2, 3) derivative of the pixels by each point's own place [px per m]."""
        rows, _ = self._rows(pose, frame)
        return np.asarray(rows @ pose.rotation[:, self.joint])

    def lens_jacobian(self, pose: Pose, frame: IndexArray) -> Array:
        """(F, N, 2) derivative of the pixels by the logarithm of the focal length [px]."""
        return np.asarray(self.pixels(pose, frame) - self.camera.principal_point)

    def _rows(self, pose: Pose, frame: IndexArray) -> tuple[Array, Array]:
        world = self.world(pose)
        return self.camera.project_jacobian(world, frame[:, None]), world


# --- Observed


PIXEL_STD = 0.35  # standard deviation of a perfect detection, as of a region's centroid [px]
EXCHANGED_COST = 3.0  # cost of taking a detector's left for right: it is wrong in one frame of twenty
LEAST_CONFIDENCE = 0.1  # a doubtful detection errs by up to ten times as much as a sure one


@dataclass(frozen=True, eq=False)
class ObservedKeypoints:
    """N keypoints in F frames, with their confidence relative to the source's sure ones."""

    pixel: Array  # (F, N, 2) [px], NaN where not seen
    confidence: Array  # (F, N) 0.1 to 1; 0 where not seen
    depth_m: Array  # (F, N) guessed distance behind the hips' middle [m]; NaN where there is none

    @classmethod
    def of(cls, keypoints: Keypoints) -> "ObservedKeypoints":
        """The keypoints of a clip."""
        seen, confidence = keypoints.seen, np.zeros(keypoints.score.shape)
        for source in dict.fromkeys(keypoints.sources):
            own = np.array([name == source for name in keypoints.sources])
            scores = keypoints.score[:, own]
            if seen[:, own].any():
                sure = max(float(np.quantile(scores[seen[:, own]], 0.9)), 1e-6)
                confidence[:, own] = np.clip(scores / sure, LEAST_CONFIDENCE, 1.0)
        return cls(
            np.where(seen[..., None], keypoints.pixel, np.nan),
            np.where(seen, confidence, 0.0),
            np.where(seen, keypoints.hint_m[..., 2], np.nan),
        )

    @property
    def seen(self) -> BoolArray:
        """(F, N) whether each is seen."""
        return np.asarray(self.confidence > 0.0)

    def only(self, kept: BoolArray) -> "ObservedKeypoints":
        """The same without those points that are not among `kept` (N,)."""
        return ObservedKeypoints(
            np.where(kept[:, None], self.pixel, np.nan),
            np.where(kept, self.confidence, 0.0),
            np.where(kept, self.depth_m, np.nan),
        )

    def __getitem__(self, index: slice | IndexArray) -> "ObservedKeypoints":
        """Those of some frames."""
        return ObservedKeypoints(self.pixel[index], self.confidence[index], self.depth_m[index])


# --- The term


@dataclass(frozen=True, eq=False)
class KeypointTerm(Term):
    """Compares every keypoint that is seen with its prediction, in pixels."""

    model: KeypointModel
    observed: ObservedKeypoints
    std_m: Array  # (N,) error of a sure detection along each axis [m]; infinite for what is not believed
    lasting: Array | None = None
    is_image: ClassVar[bool] = True

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """Two rows for each keypoint."""
        error, std_px, used = self.errors(state.pose, state.frame)
        by = None
        if slopes:
            by = self.model.pixels_jacobian(state.pose, state.frame, np.where(used, 1.0 / std_px, 0.0))
        yield Rows(error, by, used)

    def errors(self, pose: Pose, frame: IndexArray) -> tuple[Array, Array, BoolArray]:
        """Errors (F, N, 2) in standard deviations, these (F, N) [px], and which are compared (F, N)."""
        pixel, depth = self.model.camera.project(self.model.world(pose), frame[:, None])
        scale = self.model.camera.pixels_per_meter(depth)
        sure = np.maximum(self.observed.confidence, LEAST_CONFIDENCE)
        std_px = np.hypot(self.std_m * scale / sure, PIXEL_STD)
        error = (pixel - self.observed.pixel) / std_px[..., None]
        return error, std_px, np.isfinite(error).all(axis=-1) & np.isfinite(std_px)
