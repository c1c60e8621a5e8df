"""Flipping depth: what leans toward the camera leans away from it instead, and the picture stays the same."""

import numpy as np

from ..arrays import Array
from ..body import rotations
from ..body.human import LIMBS, TRUNK
from ..body.kinematics import Body
from ..body.posture import Posture
from ..camera.camera import Camera
from .dragged import planted
from .inverse_kinematics import Pull, SightLine, pulled
from .limb_chain import DISTINCT_M, LimbChain, swing

FLAT_M = 0.5 * DISTINCT_M  # a part whose ends differ less in depth has no other side [m]
LEANS = ((True, True), (True, False), (False, True))
"""Whether chest and pelvis lean to the other side: a trunk that leans wrongly mostly does so as a whole."""


def flipped(body: Body, posture: Posture, camera: Camera, part: str) -> tuple[Posture, ...]:
    """Postures in which a limb or the trunk lies on the other side in depth, the most plausible first.

    Its joints keep their image, lengths are exact, and joint limits are kept: where they forbid the flipped
    posture, it is the nearest one within them that still lies on the other side. With a limb all else stays.
    With the trunk arms and head keep their image, and the feet their place. There are up to three, and none
    where the part lies flat in the picture, so that it has no depth to flip.

    `camera` is that of the frame, as one that stands still; `part` is the trunk or a limb, as `body/human`
    names them, KeyError for another.
    """
    found: list[Posture] = []
    if part == TRUNK:
        joints = [body.skeleton.joint_index(joint) for joint in ("waist", "neck")]
        for upper, lower in LEANS:
            leaning = _with_trunk(body, posture, camera, upper, lower)
            shown = [body.pose(each).origin[joints] for each in (posture, *found, leaning)]
            if min(np.linalg.norm(shown[-1] - other, axis=-1).max() for other in shown[:-1]) > DISTINCT_M:
                found.append(leaning)
        return tuple(found)
    limb = LimbChain.of(body, part)
    lines = limb.sight_lines(posture, camera)
    before = limb.depths_m(posture, lines)
    for way in limb.ways_in_sight(posture, lines):
        changed = (way.leans != (before > 0.0)) & (np.abs(before) > FLAT_M)
        # Joint limits may hold a part back on the side where it was.
        turned = (before > 0.0) != (limb.depths_m(way.posture, lines) > 0.0)
        if changed.any() and turned[changed].all():
            found.append(way.posture)
    return tuple(found)


def _with_trunk(body: Body, posture: Posture, camera: Camera, upper: bool, lower: bool) -> Posture:
    """The posture with chest or pelvis leaning to the other side, and the rest of the body where it was."""
    pose = body.pose(posture)
    skeleton = body.skeleton
    pelvis, waist = skeleton.joint_index("pelvis"), skeleton.joint_index("waist")
    neck = skeleton.joint_index("neck")
    hips, middle, end = (np.array(pose.origin[joint]) for joint in (pelvis, waist, neck))
    new_middle = _other_place(camera, hips, middle, lower)
    new_end = _other_place(camera, new_middle, end, upper, center_before=middle)
    below = swing(middle - hips, new_middle - hips) @ pose.rotation[pelvis]
    above = swing(end - middle, new_end - new_middle) @ pose.rotation[waist]
    matrices = np.array(posture.rotations)
    matrices[skeleton.ball_joints.index(pelvis)] = below
    ball = skeleton.ball_joints.index(waist)
    bend = rotations.logarithm(below.T @ above)
    matrices[ball] = rotations.exponential(np.clip(bend, *skeleton.limits[skeleton.ball_dofs[ball]].T))
    leaning = Posture(skeleton, posture.translation, matrices, posture.angles)
    start = dict(zip(skeleton.point_names, body.points(pose), strict=True))
    now = dict(zip(skeleton.point_names, body.points(body.pose(leaning)), strict=True))
    legs = {f"{joint}.{side}": 1.0 for joint in ("hip", "knee") for side in ("L", "R")}
    held = pulled(body, leaning, planted(start), legs)
    for name in LIMBS[:2]:
        limb = LimbChain.of(body, name)
        lines = limb.sight_lines(posture, camera)
        leans = limb.depths_m(posture, lines) > 0.0
        ways = limb.ways_in_sight(held, lines)
        if ways:
            held = min(ways, key=lambda way: (int((way.leans != leans).sum()), way.strain)).posture
    line = SightLine.to(camera, start["head"])
    shoulders = ("shoulder.L", "shoulder.R")
    moved = np.mean([now[name] - start[name] for name in shoulders], axis=0)
    pull = Pull("head", line.nearest(start["head"] + moved), 0.01, line.direction, 0.1)
    return pulled(body, held, [pull], {"neck": 1.0})


def _other_place(
    camera: Camera, center: Array, place: Array, flip: bool, center_before: Array | None = None
) -> Array:
    """Where a joint lies on its line of sight, on the other side of its moved center or on the same."""
    before = center if center_before is None else center_before
    line = SightLine.to(camera, place)
    beyond = bool((place - before) @ line.direction > 0.0)
    length = float(np.linalg.norm(place - before))
    return np.asarray(line.at_distance(center, length)[int(beyond != flip)])
