"""What holds a character's controls, and custom properties of it and its bones that may let go of them."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np
from bpy.types import Action, Constraint, FCurve, Object, PoseBone

from ....core.arrays import Array
from ....core.retarget.character import JOINTS
from ....core.retarget.controls.control_channels import IN_FK, ControlKind, PlannedControl
from ....core.retarget.maps.character_map import CharacterMap, Switch
from ..actor_bones import evaluated
from ..scene_frames import CHANNELS, showing_action


def property_path(bone: str, name: str) -> str:
    """Data path of a custom property of a pose bone, or of the object itself where that has no name."""
    bone, name = bpy.utils.escape_identifier(bone), bpy.utils.escape_identifier(name)
    return f'pose.bones["{bone}"]["{name}"]' if bone else f'["{name}"]'


def _owner(armature_object: Object, bone: str) -> PoseBone | Object:
    return armature_object.pose.bones[bone] if bone else armature_object


Property = tuple[str, str]  # name of a pose bone, empty for the object, and of a custom property
Value = float | int | bool


@contextmanager
def posing(
    armature_object: Object, properties: Sequence[Property] = (), action: Action | None = None
) -> Iterator[None]:
    """Let a pose and properties be changed, or an Action be shown; afterwards all is as before."""
    had_data, data = armature_object.animation_data is not None, armature_object.animation_data_create()
    with_strips, bones = data.use_nla, armature_object.pose.bones
    values = {(bone, name): _owner(armature_object, bone)[name] for bone, name in properties}
    channels = {name: tuple(getattr(armature_object, name)) for name in CHANNELS}
    influences = [(each, each.influence) for bone in bones for each in bone.constraints]
    try:
        with showing_action(armature_object, action):
            data.use_nla = False
            yield
    finally:
        for (bone, name), value in values.items():
            _owner(armature_object, bone)[name] = value
        for name, channel in channels.items():
            setattr(armature_object, name, channel)
        for constraint, influence in influences:
            if constraint.influence != influence:
                constraint.influence = influence
        data.use_nla = with_strips
        if not had_data:
            armature_object.animation_data_clear()
        armature_object.update_tag()
        evaluated(armature_object)


def set_properties(armature_object: Object, values: Mapping[Property, Value]) -> None:
    """Set custom properties, each in the type that it has."""
    for (bone, name), value in values.items():
        held = _owner(armature_object, bone)
        held[name] = type(held[name])(value)
    armature_object.update_tag()  # what only drivers read is not evaluated again otherwise


def read_poses(armature_object: Object, names: Sequence[str]) -> tuple[Array, Array]:
    """The bones' own channels and their poses in the armature's space, as evaluated now: (N, 4, 4) each."""
    bones = evaluated(armature_object).pose.bones
    channels: list[Any] = [bones[name].matrix_basis for name in names]
    poses: list[Any] = [bones[name].matrix for name in names]
    return np.array(channels, dtype=np.float64), np.array(poses, dtype=np.float64)


def switch_values(
    character_map: CharacterMap, value: Callable[[str, Switch], Value | None]
) -> dict[Property, Value]:
    """The switches' values by limb and switch; those without one are left out."""
    switches = [(limb, own.switch) for limb, own in character_map.ik.items() if own.switch is not None]
    values = {(one.bone, one.property): value(limb, one) for limb, one in switches}
    return {key: found for key, found in values.items() if found is not None}


def keyed_values(character_map: CharacterMap, value: Callable[[str, Switch], Value]) -> dict[Property, Value]:
    """The settings, and the switches' values by limb and switch."""
    settings = {(one.bone, one.property): one.value for one in character_map.settings}
    return settings | switch_values(character_map, value)


BONE_PATH = re.compile(r'^pose\.bones\["((?:[^"\\]|\\.)*)"\]')
CONSTRAINT_PATH = re.compile(BONE_PATH.pattern + r'\.constraints\["((?:[^"\\]|\\.)*)"\]')
CARRYING = ("CHILD_OF", "ARMATURE")  # constraints that carry a bone as a parent does: its channels count


def active_constraints(bone: PoseBone) -> list[Constraint]:
    """The constraints of a bone that move it, or may do so once their influence is driven."""
    valid = [constraint for constraint in bone.constraints if constraint.is_valid]
    acting = [one for one in valid if one.influence > 0.0 and not one.mute]
    if len(acting) == len(valid):
        return valid
    paths = [CONSTRAINT_PATH.match(driver.data_path) for driver in drivers(bone.id_data)]
    driven = {tuple(map(bpy.utils.unescape_identifier, path.groups())) for path in paths if path}
    return [one for one in valid if one in acting or (bone.name, one.name) in driven]


def constraint_targets(constraint: Constraint) -> list[tuple[Object | None, str]]:
    """The objects that a constraint looks at, with names of their bones or of none."""
    targets = constraint.targets if constraint.type == "ARMATURE" else [constraint]
    return [(getattr(one, "target", None), getattr(one, "subtarget", "")) for one in targets]


def drivers(armature_object: Object) -> list[FCurve]:
    """The drivers of an armature object that work."""
    data = armature_object.animation_data
    return [] if data is None else [curve for curve in data.drivers if not curve.mute]


# --- What holds a character's controls against their keys, and which keys of its Action let go of them


CHAINS = ("IK", "SPLINE_IK")  # constraints that pose the bones above theirs, too
BESIDE_KEYS = (
    *("LIMIT_DISTANCE", "LIMIT_LOCATION", "LIMIT_ROTATION", "LIMIT_SCALE", "COPY_SCALE"),
    *("MAINTAIN_VOLUME", "TRANSFORM", "ACTION", "FLOOR", "SHRINKWRAP"),
)
"""Constraints that leave a bone the turn and place of its keys within bounds, or add to them."""
PROPERTY_PATH = r'(?:pose\.bones\["((?:[^"\\]|\\.)*)"\])?\["((?:[^"\\]|\\.)*)"\]$'

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
            elsewhere = {target for target, _ in constraint_targets(constraint)} - {armature_object, None}
            # Limits of a joint that inverse kinematics bends are those of its solver.
            beside = constraint.type in BESIDE_KEYS and bone.name not in posed
            # What adds to the bone's own keys lets these count as well.
            adds = getattr(constraint, "mix_mode", "REPLACE") != "REPLACE"
            adds = adds or getattr(constraint, "use_offset", False)
            poses = bone.name in wanted and constraint.type not in CARRYING and not adds
            carries = bone.name in wanted | above and bool(elsewhere)
            if constraint.type in CHAINS:
                poses, carries = (bone.name, constraint.name) in chains, False
            if not beside and (poses or carries):
                yield bone, constraint


def _influence(armature_object: Object, held: Held) -> float:
    return float(evaluated(armature_object).pose.bones[held[0]].constraints[held[1]].influence)


def _switch(armature_object: Object, driver: FCurve, held: Held) -> tuple[Property, Value] | None:
    """The custom property, and its value, at which a driven influence is zero."""
    for variable in driver.driver.variables:
        for target in variable.targets:
            found = re.match(PROPERTY_PATH, target.data_path) if target.id == armature_object else None
            if variable.type != "SINGLE_PROP" or found is None:
                continue
            bone, name = map(bpy.utils.unescape_identifier, found.groups(""))
            if bone and bone not in armature_object.pose.bones:
                continue
            owner = _owner(armature_object, bone)
            before = owner.get(name)
            if not isinstance(before, int | float):
                continue
            limits = owner.id_properties_ui(name).as_dict()
            for value in dict.fromkeys((0.0, 1.0, limits.get("min", 0.0), limits.get("max", 1.0))):
                set_properties(armature_object, {(bone, name): value})
                off = _influence(armature_object, held) == 0.0
                set_properties(armature_object, {(bone, name): before})
                if off:
                    return (bone, name), type(before)(value)
    return None
