"""Measurement model of keypoints: points fixed to segments, seen in the image, with Jacobians.

A detector's shoulder or hip is not the joint's center, and a nose, a knuckle or a toe is no principal point
at all. So every point of the body has a usual place in the frame of one of the skeleton's joints, from which
a calibration departs. Hands and feet do not turn against forearm and shin in a posture; their points err by
what wrists and ankles really do.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, BoolArray, IndexArray
from ..body.body_volume import HEAD_OVERSHOOT, HEEL_BEHIND
from ..body.human import HUMAN, WAIST_HEIGHT
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..body.rotations import cross
from ..body.skeleton import SIDES, Placement
from ..footage.camera import Camera
from ..footage.keypoints.keypoints import Keypoints


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


# --- Links of the body whose depth a network guesses


Ends = tuple[str, ...]  # body points whose middle is the end of a link
HIPS: Ends = ("hip.L", "hip.R")
SHOULDERS: Ends = ("shoulder.L", "shoulder.R")
HEADS: tuple[Ends, ...] = (("head",), ("nose",), ("ear.L", "ear.R"))  # what may stand for it, by preference
LIMBS = (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))


@dataclass(frozen=True, eq=False)
class DepthLinks:
    """L links between the N points of a model."""

    names: tuple[str, ...]  # (L,) without the side, which links on both sides share
    sources: tuple[str, ...]  # (L,) whose points they join
    ends: Array  # (L, N) weights of the points: 1 in all for the far end, -1 for the near one

    @classmethod
    def between(cls, names: Sequence[str], sources: Sequence[str]) -> "DepthLinks":
        """All links between points that one source has."""
        found: list[tuple[str, str, Array]] = []
        for source in dict.fromkeys(sources):
            index = {n: i for i, (n, s) in enumerate(zip(names, sources, strict=True)) if s == source}
            for name, far, near in _links(index):
                weights = np.zeros(len(names))
                for points, sign in ((far, 1.0), (near, -1.0)):
                    weights[[index[point] for point in points]] = sign / len(points)
                found.append((name, source, weights))
        ends = np.array([weights for _, _, weights in found]).reshape(len(found), len(names))
        return cls(tuple(name for name, _, _ in found), tuple(source for _, source, _ in found), ends)

    def lengths_m(self, model: KeypointModel) -> Array:
        """(L,) the links' lengths at rest [m]."""
        skeleton = model.body.skeleton
        rest = model.body.pose(Posture.from_vector(skeleton, np.zeros((1, skeleton.dof_count))))
        return np.linalg.norm(self.ends @ model.world(rest)[0], axis=-1)

    def guessed(self, depth: Array) -> Array:
        """(F, L) depths of the links by the points' guessed ones (F, N) [m]; NaN where an end is missing."""
        known = np.isfinite(depth)
        missing = (~known).astype(float) @ (self.ends != 0.0).T.astype(float)
        return np.where(missing == 0.0, np.where(known, depth, 0.0) @ self.ends.T, np.nan)

    def depths(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L) depths of the links at F poses [m]; `frame` (F,) as in the clip."""
        return np.asarray(model.camera.depth(model.world(pose), frame[:, None]) @ self.ends.T)

    def jacobian(self, model: KeypointModel, pose: Pose, frame: IndexArray) -> Array:
        """(F, L, D) derivative of the depths by the posture's tangent."""
        used = np.flatnonzero(self.ends.any(axis=0))
        world = model.world(pose)[:, used]
        axis = model.camera.depth_jacobian(world, frame[:, None])
        return np.asarray(self.ends[:, used] @ pose.along_jacobian(model.joint[used], world, axis))


def _links(index: dict[str, int]) -> list[tuple[str, Ends, Ends]]:
    """Name, far and near end of the links between the points of one source."""
    head = next((ends for ends in HEADS if all(point in index for point in ends)), ())
    wanted: list[tuple[str, Ends, Ends]] = [
        ("hips", HIPS[:1], HIPS[1:]),
        ("shoulders", SHOULDERS[:1], SHOULDERS[1:]),
        ("trunk", SHOULDERS, HIPS),
        ("head", head, SHOULDERS),
    ]
    for near, far in LIMBS:
        wanted += [(far, (f"{far}.{side}",), (f"{near}.{side}",)) for side in SIDES]
    return [
        (name, far, near)
        for name, far, near in wanted
        if far and all(point in index for point in (*far, *near))
    ]


# --- Depths of the principal points, d(θ) of the paper


DEPTH_VARIANCE_M2 = 0.1  # variance of each depth's noise v_d [m²]: the paper's 10⁵ mm²
DEPTH_STD_M = DEPTH_VARIANCE_M2**0.5


def evaluate(body: Body, camera: Camera, pose: Pose, frame: ArrayLike | None = None) -> Array:
    """Depths of the principal points along the viewing axis (paper, eq. 9).

    (..., P) [m], positive in front of the camera, of poses of any batch shape; `frame` of the batch shape.
    """
    return camera.depth(body.points(pose), _per_point(frame))


def jacobian(body: Body, camera: Camera, pose: Pose, frame: ArrayLike | None = None) -> Array:
    """Derivative of the depths by the posture's tangent step, (..., P, D); arguments as `evaluate`."""
    points = body.points(pose)
    axis = camera.depth_jacobian(points, _per_point(frame))  # (..., P, 3)
    return pose.along_jacobian([point.joint for point in body.skeleton.points], points, axis)


def _per_point(frame: ArrayLike | None) -> IndexArray | None:
    return None if frame is None else np.asarray(frame, dtype=np.intp)[..., None]


PIXEL_STD = 0.35  # standard deviation of a perfect detection, as of a region's centroid [px]
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
