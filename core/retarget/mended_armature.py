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
HEAD_TIP = 0.5  # where the head's middle is between its joint and the end of its bone


@dataclass(frozen=True, eq=False)
class ArmaturePoints:
    """How an armature has the thirteen points: bone and place at rest, in the armature's units."""

    body: RestBody
    bones: tuple[str, ...]
    places: Array  # (13, 3) from the armature's origin

    @classmethod
    def of(cls, body: RestBody) -> "ArmaturePoints":
        """The points of an armature at rest."""
        bones, places = zip(*(_anchor(body, name) for name in HUMAN.point_names), strict=True)
        return cls(body, bones, np.array(places))

    def of_poses(self, poses: Poses) -> Array:
        """(F, 13, 3) the points in the world [m]."""
        character = self.body.character
        columns = []
        for name, place in zip(self.bones, self.places, strict=True):
            rest = character.bone(name).rest
            local = character.scale * (place - rest[:3, 3]) @ rest[:3, :3]
            columns.append(poses[name][:, :3, 3] + poses[name][:, :3, :3] @ local)
        return np.stack(columns, axis=1)


def _anchor(body: RestBody, point: str) -> tuple[str, Array]:
    part, _, side = point.partition(".")
    character = body.character

    def joint(role: str) -> tuple[str, Array]:
        name = body.bones[body.first[role]].name
        return name, character.bone(name).head

    def tip(role: str, share: float) -> tuple[str, Array]:
        name, head = body.bones[body.last[role]].name, character.bone(body.bones[body.last[role]].name).head
        end = body.tip(role)
        reached = head if end is None else end @ body.stance / character.scale
        return name, head + share * (reached - head)

    if part == "head":
        role = next(role for role in ("head", "neck", "spine", "hips") if role in body.first)
        return tip(role, HEAD_TIP if role == "head" else 1.0)
    if part == "wrist":
        return joint(f"hand.{side}") if f"hand.{side}" in body.first else tip(f"forearm.{side}", 1.0)
    return joint(f"{JOINTS[part]}.{side}")


def mended_poses(points: ArmaturePoints, poses: Poses, mended: Mended, posed: IndexArray) -> dict[str, Array]:
    """Poses (F, 4, 4) by name of the bones that play a role but the toes', for a mended motion of `points`.

    `poses` are those that the motion had; at the frames `posed` a person vouches for them.
    """
    body = points.body
    moved = [bone for bone in body.bones if not bone.role.startswith("toe")]
    turns = {bone.name: _smooth(poses[bone.name][:, :3, :3], mended, posed) for bone in moved}
    goals = dict(zip(HUMAN.point_names, np.moveaxis(mended.motion.points, 1, 0), strict=True))
    found: dict[str, Array] = {}
    for bone in moved:
        pose = np.tile(np.eye(4), (len(mended.exchanged), 1, 1))
        pose[:, :3, :3] = turns[bone.name]
        if bone.carrier >= 0:
            carrier = body.bones[bone.carrier].name
            offset = np.linalg.inv(poses[carrier]) @ poses[bone.name]
            pose[:, :3, 3] = (found[carrier] @ offset)[:, :3, 3]
        found[bone.name] = pose
        if bone.carrier < 0:
            pose[:, :3, 3] = _hips_head(points, bone.name, pose[:, :3, :3], goals)
        elif bone.role in AIMS:
            end = points.places[HUMAN.point_names.index(AIMS[bone.role])]
            rest = body.character.bone(bone.name).rest
            along = unit((end - rest[:3, 3]) @ rest[:3, :3])
            way = unit(goals[AIMS[bone.role]] - pose[:, :3, 3])
            pose[:, :3, :3] = rotations.smallest(pose[:, :3, :3] @ along, way) @ pose[:, :3, :3]
        elif bone.role.startswith("foot"):
            rests = [rest for rest in mended.contacts if SIDES[rest.point] == bone.role[-1]]
            still = [nearest_rotation(pose[rest.frames, :3, :3].mean(axis=0)[None])[0] for rest in rests]
            pose[:, :3, :3] = held_turns(pose[:, :3, :3], rests, still, mended.motion.time_s)
    return found


def _smooth(turns: Array, mended: Mended, posed: IndexArray) -> Array:
    """Turns (F, 3, 3) smoothed as three points at their axes' ends; those of exchanged sides are not seen."""
    seen = np.where(mended.exchanged[:, None, None], np.nan, turns)
    columns = [smooth_path(seen[..., axis], mended.sizes, posed, turns[posed, :, axis]) for axis in range(3)]
    return nearest_rotation(np.stack(columns, axis=-1))


def _hips_head(points: ArmaturePoints, hips: str, turns: Array, goals: Mapping[str, Array]) -> Array:
    """(F, 3) head of the hips' bone, so that the middle of the hip joints is where it is to be [m]."""
    character = points.body.character
    middle = 0.5 * (goals["hip.L"] + goals["hip.R"])
    rest = character.bone(hips).rest
    at_rest = np.mean([points.places[HUMAN.point_names.index(f"hip.{side}")] for side in SIDES], axis=0)
    return np.asarray(middle - turns @ (character.scale * (at_rest - rest[:3, 3]) @ rest[:3, :3]))
