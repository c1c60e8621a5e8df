"""Measures of faults in a composed library, for tests and authors.

Joints beyond their range, feet that slide or sink, arms in the trunk.
"""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body, Pose
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion
from keymark.core.prior.motion_playback import sample_motion

from .solving import BALL, HEEL

TRUNK_RADIUS_M = (0.15, 0.105)
"""Half the trunk's width and depth between waist and chest."""


def over_time(library: Library, motion: LibraryMotion, rate_hz: float = 60.0) -> tuple[Posture, Array]:
    """Postures along one pass of a motion, and their times (T,) [s]."""
    times = np.arange(0.0, motion.duration_s + 1e-9, 1.0 / rate_hz)
    return sample_motion(library, motion, Body(library.actor), times), times


def ranges_left(library: Library) -> list[str]:
    """Every posture's degrees of freedom beyond their range."""
    found = []
    for name, posture in library.by_name.items():
        skeleton = posture.posture.skeleton
        values, limits = posture.posture.to_vector(), skeleton.limits
        beyond = np.maximum(limits[:, 0] - values, values - limits[:, 1])
        found += [
            f"{name}: {skeleton.dof_names[i]} by {np.degrees(beyond[i]):.0f} degrees"
            for i in np.flatnonzero(beyond > 0.0)
        ]
    return found


def soles(body: Body, pose: Pose) -> Array:
    """(..., 2) heights of the soles [m], left first; a foot is as flat as its ankle's position allows.

    The skeleton's foot is rigid with the shin, a person's is not: one that would dip into the floor is flat.
    """
    lengths = body.actor.segments_m
    heights = []
    for side in ("L", "R"):
        joint = body.skeleton.joint_index(f"shin.{side}")
        ankle = pose.place(joint, np.array([0.0, 0.0, -lengths[f"shin.{side}"]]))
        turns = pose.rotation[..., joint, :, :]
        places = [turns @ (lengths[f"foot.{side}"] * np.array(place)) for place in (HEEL, BALL)]
        rigid = np.min([place[..., 2] for place in places], axis=0)
        flat = lengths[f"foot.{side}"] * HEEL[2]
        heights.append(ankle[..., 2] + np.maximum(rigid, flat))
    return np.stack(heights, axis=-1)


def slides(body: Body, posture: Posture, times: Array, low_m: float = 0.02) -> float:
    """Largest drift of an ankle at rest, low over the floor and slow [m]."""
    pose = body.pose(posture)
    heights = soles(body, pose)
    worst = 0.0
    for column, side in enumerate(("L", "R")):
        point = body.skeleton.point_names.index(f"ankle.{side}")
        place = body.points(pose)[..., point, :2]
        speed = np.linalg.norm(np.gradient(place, times, axis=0), axis=-1)
        rests = (heights[:, column] < low_m) & (speed < 0.25)
        for run in np.split(np.flatnonzero(rests), np.flatnonzero(np.diff(np.flatnonzero(rests)) > 1) + 1):
            if len(run) >= 6:
                middle = place[run[len(run) // 4 : -len(run) // 4 or None]]
                worst = max(worst, float(np.linalg.norm(middle - middle.mean(axis=0), axis=-1).max()))
    return worst


def arms_in_trunk(body: Body, posture: Posture, limb_radius_m: float = 0.03) -> Array:
    """(...,) depth of an elbow, a wrist or a hand in the trunk, as a share of its radius; 0 is outside."""
    pose = body.pose(posture)
    deepest = np.zeros(posture.batch)
    chest, pelvis = (body.skeleton.joint_index(name) for name in ("waist", "pelvis"))
    for side in ("L", "R"):
        places = [*body.segment_ends(pose, f"forearm.{side}"), body.segment_ends(pose, f"hand.{side}")[1]]
        for joint in (chest, pelvis):
            top = body.actor.segments_m["trunk"] * (0.6 if joint == chest else 0.4)
            for place in places:
                away = (place - pose.origin[..., joint, :])[..., None]
                x, y, z = np.moveaxis((_transposed(pose.rotation[..., joint, :, :]) @ away)[..., 0], -1, 0)
                wide, deep = (radius + limb_radius_m for radius in TRUNK_RADIUS_M)
                beside = np.hypot(x / wide, y / deep)
                inside = np.where((z > 0.0) & (z < top), 1.0 - beside, 0.0)
                deepest = np.maximum(deepest, inside)
    return np.asarray(deepest)


def _transposed(matrices: Array) -> Array:
    return np.swapaxes(matrices, -1, -2)
