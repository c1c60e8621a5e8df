"""What holds a character's controls against their keys, and which keys of its Action let go of them."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import bpy
from bpy.types import Constraint, FCurve, Object, PoseBone

from ....core.errors import InputError
from ....core.retarget.character import JOINTS
from ....core.retarget.controls.control_plan import IN_FK, ControlKind, PlannedControl
from ....core.retarget.maps.character_map import CharacterMap
from ..object_space import evaluated
from .controls import (
    BONE_PATH,
    CARRYING,
    Property,
    Value,
    active_constraints,
    constraint_targets,
    drivers,
    set_properties,
)

CHAINS = ("IK", "SPLINE_IK")  # constraints that pose the bones above theirs, too
BESIDE_KEYS = (
    *("LIMIT_DISTANCE", "LIMIT_LOCATION", "LIMIT_ROTATION", "LIMIT_SCALE", "COPY_SCALE"),
    *("MAINTAIN_VOLUME", "TRANSFORM", "ACTION", "FLOOR", "SHRINKWRAP"),
)
"""Constraints that leave a bone the turn and place of its keys within bounds, or add to them."""
PROPERTY_PATH = BONE_PATH.pattern + r'\["((?:[^"\\]|\\.)*)"\]$'

Held = tuple[str, str]  # name of a pose bone, and of one of its constraints


@dataclass(frozen=True)
class Releases:
    """What is keyed so that controls follow their own keys."""

    constraints: tuple[Held, ...] = ()  # whose influence is keyed at zero
    switches: Mapping[Property, Value] = field(default_factory=dict)  # that drive one, at which it is zero
    bones: tuple[str, ...] = ()  # bones whose constraints are released by either
    stuck: tuple[Held, ...] = ()  # whose influence has a driver that no property was seen to switch off


def find_releases(
    armature_object: Object, character_map: CharacterMap, planned: Sequence[PlannedControl]
) -> Releases:
    """What holds the planned controls as the armature stands now, but for limbs whose IK is keyed."""
    in_ik = {str(plan.limb) for plan in planned if plan.kind is ControlKind.GOAL}
    roles = {role for limb in in_ik for role in JOINTS[limb]}
    own = {bone for role in roles for bone in (*character_map.bones(role), *character_map.keyed_bones(role))}
    turned = [plan.name for plan in planned if plan.kind in (*IN_FK, ControlKind.CARRIER, ControlKind.ROOT)]
    constraints: list[Held] = []
    switches: dict[Property, Value] = {}
    bones: list[str] = []
    stuck: list[Held] = []
    for bone, constraint in _holding(armature_object, [name for name in turned if name not in own]):
        held = (bone.name, constraint.name)
        path = constraint.path_from_id("influence")
        driver = next((one for one in drivers(armature_object) if one.data_path == path), None)
        if _influence(armature_object, held) == 0.0:
            continue
        if driver is None:
            constraints.append(held)
        elif found := _switch(armature_object, driver, held):
            switches.update([found])
        else:
            stuck.append(held)
            continue
        bones.append(bone.name)
    return Releases(tuple(constraints), switches, tuple(dict.fromkeys(bones)), tuple(stuck))


def release(armature_object: Object, releases: Releases) -> None:
    """Let go of the controls for now; `posing` restores all."""
    for bone, name in releases.constraints:
        armature_object.pose.bones[bone].constraints[name].influence = 0.0
    set_properties(armature_object, releases.switches)


def require_released(armature_object: Object, releases: Releases, warnings: Sequence[str]) -> None:
    """Raise InputError where limbs are not the performer's and something holds them that no key switches."""
    if releases.stuck and warnings:
        bone, name = releases.stuck[0]
        raise InputError(
            f"bone '{bone}' of '{armature_object.name}' is held by its constraint '{name}', whose influence "
            f"has a driver ({warnings[0]}); mute the constraint, or name its switch in the character map"
        )


def _holding(armature_object: Object, turned: Sequence[str]) -> Iterator[tuple[PoseBone, Constraint]]:
    """Constraints that pose the bones themselves, or let something else than the armature carry them."""
    bones = armature_object.pose.bones
    wanted = set(turned)
    above = {one.name for name in turned for one in bones[name].parent_recursive}
    active = {bone.name: active_constraints(bone) for bone in bones}
    chains: dict[Held, set[str]] = {}  # names of the bones that a constraint poses
    for bone in bones:
        for constraint in active[bone.name]:
            if constraint.type in CHAINS:
                chain = [bone, *bone.parent_recursive][not getattr(constraint, "use_tail", True) :]
                names = {one.name for one in chain[: constraint.chain_count or len(chain)]}
                if wanted & names:
                    chains[bone.name, constraint.name] = names
    posed = wanted & set().union(*chains.values())
    for bone in bones:
        for constraint in active[bone.name]:
            others = {target for target, _ in constraint_targets(constraint)} - {armature_object, None}
            # Limits of a joint that inverse kinematics bends are those of its solver.
            beside = constraint.type in BESIDE_KEYS and bone.name not in posed
            # What adds to the bone's own keys lets these count as well.
            adds = getattr(constraint, "mix_mode", "REPLACE") != "REPLACE"
            adds = adds or getattr(constraint, "use_offset", False)
            poses = bone.name in wanted and constraint.type not in CARRYING and not adds
            carries = bone.name in wanted | above and bool(others)
            if constraint.type in CHAINS:
                poses, carries = (bone.name, constraint.name) in chains, False
            if not beside and (poses or carries):
                yield bone, constraint


def _influence(armature_object: Object, held: Held) -> float:
    return float(evaluated(armature_object).pose.bones[held[0]].constraints[held[1]].influence)


def _switch(armature_object: Object, driver: FCurve, held: Held) -> tuple[Property, Value] | None:
    """The custom property of a pose bone, and its value, at which a driven influence is zero."""
    bones = armature_object.pose.bones
    for variable in driver.driver.variables:
        for target in variable.targets:
            found = re.match(PROPERTY_PATH, target.data_path) if target.id == armature_object else None
            if variable.type != "SINGLE_PROP" or found is None:
                continue
            bone, name = map(bpy.utils.unescape_identifier, found.groups())
            if bone not in bones or not isinstance(bones[bone].get(name), int | float):
                continue
            before = bones[bone][name]
            limits = bones[bone].id_properties_ui(name).as_dict()
            for value in dict.fromkeys((0.0, 1.0, limits.get("min", 0.0), limits.get("max", 1.0))):
                set_properties(armature_object, {(bone, name): value})
                off = _influence(armature_object, held) == 0.0
                set_properties(armature_object, {(bone, name): before})
                if off:
                    return (bone, name), type(before)(value)
    return None
