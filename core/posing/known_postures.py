"""All postures that some libraries know, and their mirror images, on one body: where a search starts from.

The body falls into a trunk and four limbs that move nearly independently; a limb is a part of its own, known
in the frame of the joint that carries it, so that it fits any trunk.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import headings_rad, yaw_rotation, yawed_at
from ..body.kinematics import Body, Pose
from ..body.limbs import LIMBS, TRUNK, limb_of
from ..body.mirror import mirrored
from ..body.posture import Posture
from ..errors import InputError
from ..library.library import Library
from ..library.transfer import transferred

PARTS = (TRUNK, *LIMBS)
CARRIERS = {"arm": "waist", "leg": "pelvis"}
"""Joint that carries a limb, by its kind."""


@dataclass(frozen=True, eq=False)
class KnownPostures:
    """N postures, all facing -Y with the hips over the origin, as high above the floor z = 0 as they are."""

    body: Body
    posture: Posture
    """(N,)."""
    names: tuple[str, ...]
    """(N,) of the libraries' postures."""
    mirrored: tuple[bool, ...]
    """(N,) whether left and right are exchanged."""
    library: IndexArray
    """(N,) number of the library that each is from."""

    def __len__(self) -> int:
        """Number of postures N."""
        return len(self.names)

    @cached_property
    def pose(self) -> Pose:
        """Their forward kinematics."""
        return self.body.pose(self.posture)

    @cached_property
    def parts(self) -> dict[str, Array]:
        """(N, 3 K) shape of each part, see `part_shapes`."""
        return part_shapes(self.body, self.pose)


def known_postures(body: Body, libraries: Sequence[Library]) -> KnownPostures:
    """The postures of some libraries on a body.

    Raises:
        InputError: No library has a posture.
    """
    batches, names, numbers = [], [], []
    for number, library in enumerate(libraries):
        if library.postures:
            own = Posture.stack([each.posture for each in library.postures])
            batches.append(transferred(own, library.actor, body))
            names += [each.name for each in library.postures]
            numbers += [number] * len(library.postures)
    if not names:
        raise InputError("no keyframe library with a posture is given; at least one is needed to find poses")
    plain = Posture.concatenate(batches)
    both = Posture.concatenate([plain, mirrored(plain)])
    hips = np.zeros((len(both.translation), 3))
    hips[:, 2] = both.translation[:, 2]
    ahead = yawed_at(both, -headings_rad(both), hips)
    flags = (False,) * len(names) + (True,) * len(names)
    return KnownPostures(body, ahead, (*names, *names), flags, np.array(numbers * 2, dtype=np.intp))


def part_shapes(body: Body, pose: Pose) -> dict[str, Array]:
    """Shapes (N, 3 K) of the parts of some postures: distances of shapes are root mean squares of points [m].

    The trunk's are shoulders and head from the hips, heading left out; a limb's its two farther points in the
    frame of the joint that carries it.
    """
    skeleton = body.skeleton
    points, names = body.points(pose), skeleton.point_names
    shapes: dict[str, Array] = {}
    trunk = [names.index(name) for name in ("head", "shoulder.L", "shoulder.R", "hip.L")]
    upper: Array = points[:, trunk] - pose.posture.translation[:, None]
    shapes[TRUNK] = _flat(np.einsum("nki,nij->nkj", upper, yaw_rotation(headings_rad(pose.posture))))
    for limb in LIMBS:
        joint = skeleton.joint_index(CARRIERS[limb.partition(".")[0]])
        own = [index for index, name in enumerate(names) if limb_of(name) == limb]
        shapes[limb] = _flat((points[:, own] - pose.origin[:, None, joint]) @ pose.rotation[:, joint])
    return shapes


def _flat(points: Array) -> Array:
    return np.asarray(points.reshape(len(points), -1) / np.sqrt(points.shape[1]))
