"""Alignment of rest poses: the turn that takes each role's rest to that of the performer's body.

The performer at rest stands in a T pose. A limb of the character may rest anywhere (T, A, hanging, with bent
elbows or knees): each bone takes on the turn of the one before it and then the smallest rotation of its
direction, as if the character's arm were raised first and then stretched. So hinges and palms keep their
places on the limb. Trunk, head, clavicles and feet are upright in both, and are not turned.
"""

from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array
from ...body import rotations
from ...body.skeleton import SIDES
from ...numerics.vectors import unit
from .rest_body import RestBody
from .smoothing import ease
from .two_bone import smallest_rotation

CLEAR_BEND_RAD = (np.radians(12.0), np.radians(30.0))
"""Bend of a resting elbow or knee from which its plane begins to count, and counts in full."""
LARGEST_TWIST_RAD = np.radians(75.0)
"""A resting bend farther than that from the hinge's own direction says nothing of it."""


def rest_alignment(body: RestBody) -> Mapping[str, Array]:
    """(3, 3) by role: the turn from the character's rest, in canonical axes, to the performer's."""
    turns = {role: _correction(body, role) for role in body.first}
    for side in SIDES:
        out = 1.0 if side == "L" else -1.0
        arm = [f"{part}.{side}" for part in ("upper_arm", "forearm", "hand")]
        leg = [f"{part}.{side}" for part in ("thigh", "shin", "foot")]
        _align(body, turns, arm, np.array([out, 0.0, 0.0]), np.array([0.0, 0.0, -out]))
        _align(body, turns, leg, np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0]))
        if f"hand.{side}" in turns:
            own = turns[f"hand.{side}"]
            turns[f"hand.{side}"] = turns[f"forearm.{side}"] @ own
    return turns


def _correction(body: RestBody, role: str) -> Array:
    """The map's correction of a role's rest, in canonical axes."""
    given = body.character_map.rest_corrections.get(role)
    if given is None:
        return np.eye(3)
    w, x, y, z = given
    turn = Rotation.from_quat([x, y, z, w]).as_matrix()
    return np.asarray(body.stance @ turn @ body.stance.T)


def _align(body: RestBody, turns: dict[str, Array], limb: list[str], along: Array, hinge: Array) -> None:
    """Align a limb's two long bones: `along` and `hinge` are its direction and axis in the T pose."""
    upper, lower, end = limb
    middle = body.joint(lower)
    first = unit(middle - body.joint(upper))
    tip = body.joint(end) if end in body.first else body.tip(lower)
    second = first if tip is None else unit(tip - middle)
    corrected = turns[upper] @ first
    turn = smallest_rotation(corrected, along) @ turns[upper]
    turn = _with_hinge(turn @ first, turn @ second, along, hinge) @ turn
    turns[upper] = turn
    bent = turn @ turns[lower] @ second
    turns[lower] = smallest_rotation(bent, along) @ turn @ turns[lower]


def _with_hinge(first: Array, second: Array, along: Array, hinge: Array) -> Array:
    """A twist about the limb that lets its resting bend turn about the hinge; none where it hardly bends."""
    axis = rotations.cross(first, second)
    bend = float(np.arctan2(np.linalg.norm(axis), first @ second))
    axis = unit(axis)
    twist = float(np.arctan2(rotations.cross(axis, hinge) @ along, axis @ hinge))
    clear = float(ease(np.array(bend), *CLEAR_BEND_RAD)) * float(abs(twist) < LARGEST_TWIST_RAD)
    return rotations.hinge(along, np.array(clear * twist))
