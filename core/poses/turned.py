"""Turning the performer to face the camera, left, right or away, with as much of the image kept as possible.

Wrong about a pose that faces the wrong way is either the trunk alone, where each limb is seen where it is
(markers and keypoints say which limb is which), or the depth of the whole body with left and right exchanged,
which leaves its outline as it is.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..arrays import Array
from ..body.human import LIMBS
from ..body.kinematics import Body
from ..body.mirror import mirrored, other_side
from ..body.posture import Posture, facing_rad, headings_rad, yaw_rotation, yawed_in_place
from ..camera.camera import Camera
from .inverse_kinematics import Pull, SightLine, pulled
from .limb_chain import LimbChain


class Facing(Enum):
    """Where the performer faces, seen from the camera."""

    CAMERA = "camera"
    LEFT = "left"  # to the left of the picture
    RIGHT = "right"
    AWAY = "away"


class Sides(Enum):
    """What becomes of left and right when the performer is turned."""

    STAY = "stay"  # each arm and leg stays where it is in the picture; the trunk turns between them
    EXCHANGE = "exchange"  # left limbs take the right ones' place in the picture: the outline stays
    TURN = "turn"  # everything turns with the trunk, as on a turntable


@dataclass(frozen=True, eq=False)
class Turned:
    """A posture that faces another way."""

    posture: Posture
    sides: Sides
    strain: float  # how implausible its limbs are, see `LimbChain.strain`


def facing_heading_rad(camera: Camera, place: Array, facing: Facing) -> float:
    """Heading [rad] of a performer at a place (3,) [m] who faces one way, by the frame's own camera."""
    rotation, eye = camera.pose()
    toward = facing_rad(eye - place)
    # A camera nearer than this [m] to the vertical through the performer is in no direction from there.
    if np.hypot(*(eye - place)[:2]) < 1e-6:
        toward = facing_rad(-rotation[:, 1])  # to the lower edge of the picture
    # The performer's left is +X where they face -Y: toward the camera, that is to the right of the picture.
    steps = {Facing.CAMERA: 0.0, Facing.RIGHT: 1.0, Facing.AWAY: 2.0, Facing.LEFT: -1.0}
    return float(toward + 0.5 * np.pi * steps[facing])


def facing_of(posture: Posture, camera: Camera) -> Facing:
    """The one of the four ways that is nearest to where a single posture faces."""
    heading = float(headings_rad(posture))
    away = {f: _apart_rad(facing_heading_rad(camera, posture.translation, f), heading) for f in Facing}
    return min(away, key=lambda facing: away[facing])


def turned(body: Body, posture: Posture, camera: Camera, facing: Facing, sides: Sides) -> Turned:
    """A single posture turned about the vertical through its hips, by the frame's own camera."""
    goal = facing_heading_rad(camera, posture.translation, facing)
    if sides is Sides.TURN:
        along = sum(LimbChain.of(body, name).strain(posture) for name in LIMBS)
        return Turned(_at_heading(posture, goal), sides, along)
    if sides is Sides.STAY:
        base, names = _at_heading(posture, goal), {limb: limb for limb in LIMBS}
    else:
        base, names = _exchanged(posture, camera, goal), {limb: other_side(limb) for limb in LIMBS}
    # The limbs are laid on the lines of sight to where they, or those of the other side, were seen.
    strain = 0.0
    laid = base
    for name, source in names.items():
        limb = LimbChain.of(body, name)
        ways = limb.ways_in_sight(laid, LimbChain.of(body, source).sight_lines(posture, camera))
        if ways:
            # Of two ways the one more like before: mean square change of the limb's joints [rad²].
            changed = [float(np.mean(way.posture.minus(base)[limb.dofs] ** 2)) for way in ways]
            best = ways[int(np.argmin(np.add([way.strain for way in ways], changed)))]
            laid, strain = best.posture, strain + best.strain
    column = body.skeleton.point_names.index("head")
    head, now = (body.points(body.pose(each))[column] for each in (posture, laid))
    line = SightLine.to(camera, head)
    # How near the head comes to its sight, and to its turned depth [m].
    pull = Pull("head", line.nearest(now), 0.02, line.direction, 0.3)
    return Turned(pulled(body, laid, [pull], {"neck": 1.0}), sides, strain)


def _at_heading(posture: Posture, heading_rad: float) -> Posture:
    turn = heading_rad - float(headings_rad(posture))
    return yawed_in_place(posture, np.array([turn]))[0]


def _exchanged(posture: Posture, camera: Camera, heading_rad: float) -> Posture:
    """The mirror image in depth, left and right exchanged; turned on where that faces another way.

    A reflection in depth leaves every image in place but for perspective, and turns front into back.
    """
    _, eye = camera.pose()
    depth = facing_rad(posture.translation - eye) - 0.5 * np.pi  # of the direction of sight from +X
    image = mirrored(posture)
    rotation = np.array(image.rotations)
    # A reflection across a vertical plane is the one across x = 0, turned by twice the angle between them.
    rotation[0] = yaw_rotation(2.0 * depth) @ rotation[0]
    reflected = Posture(posture.skeleton, posture.translation, rotation, image.angles)
    faces = float(headings_rad(reflected))
    # Of the four directions, the nearest to a heading is at most an eighth of a turn away.
    return reflected if _apart_rad(faces, heading_rad) <= np.pi / 4.0 else _at_heading(reflected, heading_rad)


def _apart_rad(first: float, second: float) -> float:
    return abs(float((first - second + np.pi) % (2.0 * np.pi) - np.pi))
