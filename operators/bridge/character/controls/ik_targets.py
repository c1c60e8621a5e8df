"""Constraints of inverse kinematics that move a limb: the bones that they reach for and point to."""

from collections.abc import Iterable
from dataclasses import dataclass

import bpy

from .....core.retarget.controls.control_plan import limb_bones
from .....core.retarget.maps.character_map import CharacterMap
from .....core.retarget.roles import LIMBS
from .dependencies import Graph, active_constraints, upstream

ABOVE = {"arm": ("spine", "hips"), "leg": ("hips",)}
"""Roles that carry arms and legs, the nearest first."""


@dataclass(frozen=True)
class IkTargets:
    """What a limb's inverse kinematics looks at."""

    goal: str
    pole: str | None


def ik_targets(
    armature_object: bpy.types.Object, graph: Graph, character_map: CharacterMap, limb: str
) -> IkTargets | None:
    """The bones that a limb's inverse kinematics reaches for and points to; None where it has none."""
    upper, middle, _ = limb_bones(character_map, limb)
    for name in sorted(moving_bones(graph, character_map, limb, (upper, middle))):
        bone = armature_object.pose.bones.get(name)
        for constraint in [] if bone is None else active_constraints(bone):
            if constraint.type == "IK" and constraint.target == armature_object and constraint.subtarget:
                pole = constraint.pole_subtarget if constraint.pole_target == armature_object else ""
                return IkTargets(constraint.subtarget, pole or None)
    return None


def moving_bones(graph: Graph, character_map: CharacterMap, limb: str, bones: Iterable[str]) -> set[str]:
    """All on which bones of a limb depend, but nothing on which its trunk depends too."""
    return upstream(graph, bones) - upstream(graph, _above(character_map, limb))


def _above(character_map: CharacterMap, limb: str) -> list[str]:
    """The bones that carry a limb."""
    kind = limb.partition(".")[0]
    first = LIMBS[limb][:1] if kind == "arm" else ()
    return [bone for role in (*first, *ABOVE[kind]) for bone in character_map.bones(role)]
