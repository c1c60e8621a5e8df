"""The head's turn as faces tell it: three rows on its orientation in the world, with errors that last.

The points of the head that a body's network sees lie close together; a network that looks at the face alone
sees how it turns. Where it finds none, the body's own points of the head tell the turn less well, and nothing
from behind, where both guess.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.posture_fit import nearest_rotation
from ..body.rotations import exponential, logarithm, right_jacobian_inverse, smallest
from ..camera.camera import Camera
from ..detect.keypoints import FACE as FACE_POINTS
from ..detect.keypoints import FACING, Keypoints
from .keypoints import FACE
from .term import ClipState, Rows, Term

_SIDED = [[-1.0 if name.endswith(".R") else 1.0, 1.0, 1.0] for name in FACE_POINTS]
USUAL_FACE = np.array([FACE[name.partition(".")[0]] for name in FACE_POINTS]) * _SIDED
"""Places of `FACE_POINTS` in the head's frame, in lengths of `neck_head`."""
FLIP = np.diag([1.0, -1.0, -1.0])  # between these and the camera's own
PRESENT = 0.98  # a face that is less sure is none
NEAR_STD_RAD, ASIDE_STD_RAD, POINTS_STD_RAD = np.radians([7.0, 25.0, 16.0])
"""Errors of a turn by a face within `ASIDE_RAD` of the viewer and beyond, and by the body's points."""
ASIDE_RAD, BEHIND_RAD = np.radians([60.0, 100.0])
MEMORY_S = 0.5  # time in which an error fades to a third: it is one of a view of the head


@dataclass(frozen=True, eq=False)
class ObservedHeads:
    """How the head is turned in F frames."""

    turn: Array  # (F, 3, 3) in the world from rest, any where it is not seen
    std_rad: Array  # (F,) its error about each axis; infinite where it is not seen

    @classmethod
    def of(cls, keypoints: Keypoints, camera: Camera) -> "ObservedHeads | None":
        """Those of a clip's keypoints; None where no head was looked at."""
        if not np.isfinite(keypoints.face).any():
            return None
        looked = np.isfinite(keypoints.face).all(axis=-1)
        face = np.where(looked[:, None], keypoints.face, 0.0)
        by_face, by_points = exponential(face[:, 2:5]), _by_points(keypoints)
        guessed = np.isfinite(by_points).all(axis=(1, 2))
        by_points = np.where(guessed[:, None, None], by_points, np.eye(3))
        before = np.where(guessed, _aside(by_points), 0.0) < BEHIND_RAD
        aside = _aside(by_face)
        found = looked & before & (face[:, 5] > PRESENT) & (aside < BEHIND_RAD)
        std_rad = np.where(aside < ASIDE_RAD, NEAR_STD_RAD, ASIDE_STD_RAD)
        std_rad = np.where(found, std_rad, np.where(looked & before & guessed, POINTS_STD_RAD, np.inf))
        middle = np.where(looked[:, None], face[:, :2], camera.principal_point)
        axes = viewer_axes(camera, middle, np.arange(len(face)))
        seen = np.where(found[:, None, None], by_face, by_points)
        return cls(axes @ seen @ FACING, np.where(np.isfinite(axes).all(axis=(-2, -1)), std_rad, np.inf))

    @property
    def seen(self) -> BoolArray:
        """(F,) whether the turn is seen."""
        return np.isfinite(self.std_rad)

    def __getitem__(self, frames: slice) -> "ObservedHeads":
        """Those of some frames."""
        return ObservedHeads(self.turn[frames], self.std_rad[frames])


def viewer_axes(camera: Camera, pixel: Array, frame: IndexArray) -> Array:
    """(F, 3, 3) axes in the world of who looks at pixels (F, 2): x right, y down, z away along the sight."""
    axes = camera.pose(frame)[0] @ FLIP
    sight = camera.rays(pixel, frame)[1]
    return np.asarray(smallest(np.broadcast_to(axes[..., 2], sight.shape), sight) @ axes)


def _aside(turn: Array) -> Array:
    """(F,) angle between where a head faces and the viewer [rad]."""
    return np.arccos(np.clip(turn[..., 2, 2], -1.0, 1.0))


def _by_points(keypoints: Keypoints) -> Array:
    """(F, 3, 3) turn from facing the viewer by the guess of nose, eyes and ears in space; NaN where none."""
    number = {name: index for index, name in enumerate(keypoints.names)}
    turn = np.full((keypoints.frame_count, 3, 3), np.nan)
    if not set(FACE_POINTS) <= set(number):
        return turn
    seen = keypoints.hint_m[:, [number[name] for name in FACE_POINTS]]
    known = np.isfinite(seen).all(axis=(1, 2))
    usual = USUAL_FACE @ FACING.T
    apart = seen[known] - seen[known].mean(axis=1, keepdims=True)
    turn[known] = nearest_rotation(np.swapaxes(apart, -1, -2) @ (usual - usual.mean(axis=0)))
    return turn


@dataclass(frozen=True, eq=False)
class HeadTerm(Term):
    """Compares the head's turn with what was seen of it."""

    observed: ObservedHeads
    lasting: Array

    def rows(self, state: ClipState, slopes: bool = True) -> Iterator[Rows]:
        """Three rows."""
        joint = state.body.skeleton.segment("head").joint
        turn, used = state.pose.rotation[:, joint], self.observed.seen
        std_rad = np.where(used, self.observed.std_rad, 1.0)[:, None]
        apart = logarithm(np.swapaxes(self.observed.turn, -1, -2) @ turn)
        by = None
        if slopes:
            angular = np.swapaxes(turn, -1, -2) @ state.pose.screws[:, 3:]
            by = right_jacobian_inverse(apart) @ angular * state.body.skeleton.moved_by[joint]
            by = (by / std_rad[..., None])[:, None]
        yield Rows((apart / std_rad)[:, None], by, used[:, None])
