"""A mended motion on the armature it came from: bones keep their lengths, and what has no role its motion.

Its bones' own turns are smoothed as the points were (`core/numerics/wandering`), then arms and legs are aimed
at the mended joints. Poses are of bones in the world: axes of length one as columns, then the head [m].
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body import rotations
from ..body.human import HUMAN
from ..body.posture_fit import nearest_rotation
from ..body.skeleton import SIDES
from ..feet.fading import held_turns
from ..mend.mend_motion import Mended
from ..numerics.vectors import unit
from ..numerics.wandering import smooth_path
from .solve.rest_body import RestBody

Poses = Mapping[str, Array]  # (F, 4, 4) by name of bone
AIMS = {
    f"{part}.{side}": f"{point}.{side}"
    for part, point in (("upper_arm", "elbow"), ("forearm", "wrist"), ("thigh", "knee"), ("shin", "ankle"))
    for side in SIDES
}
"""The mended point that each bone of a limb is aimed at."""
JOINTS = {"shoulder": "upper_arm", "elbow": "forearm", "hip": "thigh", "knee": "shin", "ankle": "foot"}
"""The role whose bone begins at each point."""


@dataclass(frozen=True, eq=False)
class ArmaturePoints:
    """How an armature has the thirteen points: bone and place at rest, in the armature's units."""

    body: RestBody
    bones: tuple[str, ...]
    places: Array  # (13, 3) from the armature's origin

    @classmethod
    def of(cls, body: RestBody) -> "ArmaturePoints":
        """The points of an armature at rest."""
        character, bones, places = body.character, [], []
        for point in HUMAN.point_names:
            part, _, side = point.partition(".")
            role, share = f"{JOINTS.get(part, 'hand')}.{side}", 0.0  # of the way from its joint to its end
            if part == "head":
                role = next(role for role in ("head", "neck", "spine", "hips") if role in body.first)
                share = 0.5 if role == "head" else 1.0
            elif role not in body.first:
                role, share = f"forearm.{side}", 1.0
            name = body.bones[(body.last if share else body.first)[role]].name
            head, tip = character.bone(name).head, body.tip(role)
            end = head if tip is None else tip @ body.stance / character.scale
            bones.append(name)
            places.append(head + share * (end - head))
        return cls(body, tuple(bones), np.array(places))

    def of_poses(self, poses: Poses) -> Array:
        """(F, 13, 3) the points in the world [m]."""
        character = self.body.character
        columns = []
        for name, place in zip(self.bones, self.places, strict=True):
            rest = character.bone(name).rest
            local = character.scale * (place - rest[:3, 3]) @ rest[:3, :3]
            columns.append(poses[name][:, :3, 3] + poses[name][:, :3, :3] @ local)
        return np.stack(columns, axis=1)


def mended_poses(points: ArmaturePoints, poses: Poses, mended: Mended, posed: IndexArray) -> dict[str, Array]:
    """Poses (F, 4, 4) by name of the bones that play a role but the toes', for a mended motion of `points`.

    `poses` are those that the motion had; at the frames `posed` a person vouches for them.
    """
    body, scale = points.body, points.body.character.scale
    at_rest = dict(zip(HUMAN.point_names, points.places, strict=True))
    goals = dict(zip(HUMAN.point_names, np.moveaxis(mended.motion.points, 1, 0), strict=True))
    for held in (at_rest, goals):
        held["hips"] = 0.5 * (held["hip.L"] + held["hip.R"])
    found: dict[str, Array] = {}
    for bone in (one for one in body.bones if not one.role.startswith("toe")):
        given, rest = poses[bone.name][:, :3, :3], body.character.bone(bone.name).rest
        # Turns are smoothed as three points at their axes' ends; those of exchanged sides are not seen.
        seen = np.where(mended.exchanged[:, None, None], np.nan, given)
        ends = [smooth_path(seen[..., axis], mended.sizes, posed, given[posed, :, axis]) for axis in range(3)]
        pose = found[bone.name] = np.tile(np.eye(4), (len(given), 1, 1))
        pose[:, :3, :3] = turns = nearest_rotation(np.stack(ends, axis=-1))
        if bone.carrier < 0:  # so that the middle of the hip joints is where it is to be
            pose[:, :3, 3] = goals["hips"] - turns @ (scale * (at_rest["hips"] - rest[:3, 3]) @ rest[:3, :3])
            continue
        carrier = body.bones[bone.carrier].name
        offset = np.linalg.inv(poses[carrier]) @ poses[bone.name]
        pose[:, :3, 3] = (found[carrier] @ offset)[:, :3, 3]
        if bone.role in AIMS:
            along = unit((at_rest[AIMS[bone.role]] - rest[:3, 3]) @ rest[:3, :3])
            way = unit(goals[AIMS[bone.role]] - pose[:, :3, 3])
            pose[:, :3, :3] = rotations.smallest(turns @ along, way) @ turns
        elif bone.role.startswith("foot"):
            rests = [one for one in mended.contacts if SIDES[one.point] == bone.role[-1]]
            still = [nearest_rotation(turns[one.frames].mean(axis=0)[None])[0] for one in rests]
            pose[:, :3, :3] = held_turns(turns, rests, still, mended.motion.time_s)
    return found
