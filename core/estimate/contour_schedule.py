"""How far from the predicted contours edges are looked for, look after look.

Five markers locate trunk, arms and legs to a few pixels, and edges are looked for nearby. What no marker
locates lies where the keyframes' interpolation puts it, off by decimeters: there the first look is wide, and
each later one, from a posture that is better known, narrower.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import BoolArray
from ..body.body_volume import TRUNK
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from ..footage.keypoints.keypoints import Keypoints
from .contour_search import NARROW, SearchRange

WIDEST_M = (0.25, 0.13, 0.20)
"""Reach, deviation and farthest edge of the first look: interpolation of keyframes errs by 5 to 20 cm."""
LOOKS = 9
"""Looks of the schedule; each is about a seventh narrower than the one before."""
LARGEST_REACH_PX = 36
"""Bound of the first look's reach, for the sake of time."""
BY_KEYPOINTS = 0.5
"""Width of the first look where keypoints locate the limbs: these err by 2 to 6 cm, and at times by more."""
ENDS = (
    ("wrist.L",),
    ("wrist.R",),
    ("ankle.L",),
    ("ankle.R",),
    ("hip.L", "hip.R", "shoulder.L", "shoulder.R"),
)
"""Body points of which one of each group locates its limb, or the trunk."""
HEAD = "head"


@dataclass(frozen=True)
class Schedule:
    """Looks, one after the other."""

    looks: tuple[SearchRange, ...]

    @property
    def judging(self) -> SearchRange:
        """The search at keyframes: those posed by hand are off by several centimeters."""
        return self.looks[2 * len(self.looks) // 3]

    @property
    def is_wide(self) -> bool:
        """Whether edges are looked for farther away than markers leave them."""
        return any(look != NARROW for look in self.looks)


BY_MARKERS = Schedule((NARROW, NARROW))
"""Where markers locate every limb."""


def contour_schedule(
    body: Body,
    camera: Camera,
    factor: int,
    marked: tuple[str, ...],
    prior: Posture,
    keypoints: Keypoints | None = None,
) -> Schedule:
    """The looks for a clip.

    Args:
        body: The actor's body.
        camera: The camera.
        factor: Pixels of the camera to one of the pictures.
        marked: The segments that markers are bound to.
        prior: F postures, by which the performer's distance is known.
        keypoints: Of the performer in the F frames.
    """
    if all_located(body, marked):
        return BY_MARKERS
    depth = np.median(camera.depth(prior.translation, np.arange(prior.batch[0])))
    scale = camera.focal_px / max(float(depth), 0.1) / factor
    last = np.array([NARROW.reach, NARROW.prior_std, NARROW.farthest])
    first = np.array(WIDEST_M) * min(scale, LARGEST_REACH_PX / WIDEST_M[0])
    if keypoints is not None and points_locate(keypoints):
        first *= BY_KEYPOINTS
    looks = np.geomspace(np.maximum(first, last), last, LOOKS)
    return Schedule(
        tuple(SearchRange(round(reach), std, farthest) for reach, std, farthest in looks.tolist())
    )


def all_located(body: Body, marked: tuple[str, ...]) -> bool:
    """Whether markers locate the trunk, both arms and both legs."""
    return bool(_limbs_located(body, marked).all())


def points_locate(keypoints: Keypoints) -> bool:
    """Whether keypoints show the ends of all limbs, and the trunk, in most frames."""
    seen = keypoints.seen.mean(axis=0)
    best = {name: 0.0 for group in ENDS for name in group}
    for name, share in zip(keypoints.names, seen.tolist(), strict=True):
        best[name] = max(best.get(name, 0.0), share)
    return all(max(best[name] for name in group) > 0.5 for group in ENDS)


def _limbs_located(body: Body, marked: tuple[str, ...]) -> BoolArray:
    """Whether a marker is worn on each limb, trunk first; the head, which needs none, goes with the trunk."""
    skeleton = body.skeleton
    first = {one.name: int(skeleton.dof_starts[one.joint]) for one in skeleton.segments}
    trunk, *limbs = skeleton.limbs
    worn = {first[name] for name in marked if name != TRUNK}
    return np.array(
        [
            TRUNK in marked or not worn.isdisjoint(trunk.tolist()),
            *(not worn.isdisjoint(limb.tolist()) for limb in limbs if first[HEAD] not in limb),
        ]
    )
