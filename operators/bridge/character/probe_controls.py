"""Find out how a character's controls act: pose them at random for a moment, and see what moves what."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np
from bpy.types import Object
from mathutils import Matrix

from ....core.arrays import Array
from ....core.body.rotations import exponential
from ....core.retarget.controls import control_channels
from ....core.retarget.controls.control_channels import (
    Control,
    ControlKind,
    ControlSpace,
    PlannedControl,
    PosedControls,
)
from ....core.retarget.controls.control_motion import SHORTEST_POLE, PoleSetting, pole_offset
from ....core.retarget.maps.character_map import CharacterMap
from . import held_controls
from .write_retargeted import ONE, scaled_bones

STILL, MOVED = 3, 4  # poses at random, without and with locations
FOLLOWS_RAD, FOLLOWS = 0.02, 0.01
"""Turn, and distance in sizes, up to which a bone follows its control as it was seen to; else as at rest."""
NOTICEABLE_RAD, NOTICEABLE = 0.3, 0.05
"""Turn, and distance in sizes, by which a bone may fail to follow its control before a note is made."""


@dataclass(frozen=True, eq=False)
class ProbedControls:
    """A character's controls, and how the bones with roles follow them."""

    controls: tuple[Control, ...]  # those that turn or carry others first
    offsets: Mapping[str, Array]  # (4, 4) by control the pose of its bone in its own axes
    poles: Mapping[str, PoleSetting]  # by pole where it belongs
    size: float  # the character's, in the armature's units
    notes: tuple[str, ...]
    releases: held_controls.Releases  # what lets the controls follow their keys


def probe_controls(
    armature_object: Object, character_map: CharacterMap, planned: Sequence[PlannedControl]
) -> ProbedControls:
    """How the planned controls act, settings and switches as the motion has them; nothing stays changed."""
    roles = [name for role in character_map.roles for name in character_map.bones(role)]
    size = float(np.ptp(_rests(armature_object, roles)[:, :3, 3], axis=0).max())
    notes: list[str] = []
    in_fk = held_controls.keyed_values(character_map, lambda _, switch: switch.fk)
    bones = armature_object.pose.bones
    # Location of a control that counts as one, in sizes of the character.
    displaced = {plan.name for plan in planned if bones[plan.name].location.length > 1e-5 * size}
    with held_controls.posing(armature_object, list(in_fk)):
        held_controls.set_properties(armature_object, in_fk)
        releases = held_controls.find_releases(armature_object, character_map, planned)
    with held_controls.posing(armature_object, [*in_fk, *releases.switches]):
        held_controls.set_properties(armature_object, in_fk)
        held_controls.release(armature_object, releases)
        for name in scaled_bones(armature_object, [plan.name for plan in planned]):
            bones[name].scale = ONE
        posed, followed = _posed_at_random(armature_object, planned, size)
    kept = _steady(armature_object, planned, control_channels.find_spaces(posed), notes)
    posed, followed = control_channels.chosen(posed, kept), followed[:, kept]
    planned = [planned[index] for index in kept]
    spaces = _on_goals(armature_object, planned, control_channels.find_spaces(posed))
    controls = control_channels.ordered_controls(
        [
            Control(
                plan,
                bones[plan.name].rotation_mode,
                space,
                turns=plan.kind not in (ControlKind.POLE, ControlKind.CARRIER),
                displaced=plan.name in displaced,
            )
            for plan, space in zip(planned, spaces, strict=True)
        ]
    )
    offsets = _offsets(armature_object, posed, followed, planned, size, notes)
    poles = {
        plan.name: _pole_setting(
            armature_object, [*control_channels.limb_bones(character_map, str(plan.limb)), plan.name]
        )
        for plan in planned
        if plan.kind is ControlKind.POLE
    }
    placed = tuple(_placed(armature_object, control, controls, size) for control in controls)
    return ProbedControls(placed, offsets, poles, size, tuple(notes), releases)


def _posed_at_random(
    armature_object: Object, planned: Sequence[PlannedControl], size: float
) -> tuple[PosedControls, Array]:
    """The controls as posed at random, the same in every run, and poses (S, C, 4, 4) of their bones."""
    rng = np.random.default_rng(4)
    names, count = [plan.name for plan in planned], len(planned)
    channels, shown = [], []
    for sample in range(STILL + MOVED):
        matrices = np.tile(np.eye(4), (count, 1, 1))
        matrices[:, :3, :3] = exponential(rng.normal(0.0, 0.4, (count, 3)))  # by 0.4 rad about each axis
        if sample >= STILL:
            matrices[:, :3, 3] = rng.normal(0.0, 0.1 * size, (count, 3))
        for name, matrix in zip(names, matrices, strict=True):  # in the rotation modes that they have
            armature_object.pose.bones[name].matrix_basis = Matrix(matrix)
        own, poses = held_controls.read_poses(armature_object, [*names, *(plan.bone for plan in planned)])
        channels.append(own[:count])
        shown.append(poses)
    both = np.array(shown)
    return PosedControls(np.array(channels), both[:, :count], STILL), both[:, count:]


def _rests(armature_object: Object, names: Sequence[str]) -> Array:
    """(N, 4, 4) poses of bones at rest."""
    bones = armature_object.data.bones
    return np.array([bones[name].matrix_local for name in names], dtype=np.float64)


def _offsets(
    armature_object: Object,
    posed: PosedControls,
    bones: Array,
    planned: Sequence[PlannedControl],
    size: float,
    notes: list[str],
) -> dict[str, Array]:
    """How bones follow their controls: in FK as seen, in IK as at rest; sentences on others are added."""
    offsets = {}
    for index, plan in enumerate(planned):
        control, bone = _rests(armature_object, [plan.name, plan.bone])
        offsets[plan.name] = np.linalg.inv(control) @ bone
        if plan.kind not in control_channels.IN_FK:
            continue
        # Locations of other controls may stretch what lies between: only the first poses count.
        offset, turn_rad, distance = control_channels.rigid_offset(
            posed.poses[: posed.still, index], bones[: posed.still, index]
        )
        if turn_rad <= FOLLOWS_RAD and distance <= FOLLOWS * size:
            offsets[plan.name] = offset
        _, own_rad = control_channels.constant_turn(posed.poses[: posed.still, index, :3, :3])
        # Three quarters of its own turns a bone may miss: those of Rigify's spines follow two by half.
        if turn_rad > max(NOTICEABLE_RAD, 0.75 * own_rad) or distance > NOTICEABLE * size:
            notes.append(
                f"Bone '{plan.bone}' does not follow its control '{plan.name}' rigidly; its poses may be off"
            )
    return offsets


def _pole_setting(armature_object: Object, names: Sequence[str]) -> PoleSetting:
    """Where a limb's pole belongs, whose name is last: as far and in the direction that it lies at rest."""
    root, middle, end, pole = _rests(armature_object, names)[:, :3, 3]
    length = float(np.linalg.norm(middle - root) + np.linalg.norm(end - middle))
    distance = float(np.linalg.norm(pole - middle))
    # Joints that span less are those of a straight limb, which shows no plane.
    bent = float(np.linalg.norm(np.cross(middle - root, end - root))) > 0.005 * length**2
    offset_rad = pole_offset(root, middle, end, pole) if bent else 0.0
    return PoleSetting(distance if distance > SHORTEST_POLE * length else 0.5 * length, offset_rad)


def _steady(
    armature_object: Object,
    planned: Sequence[PlannedControl],
    spaces: Sequence[ControlSpace],
    notes: list[str],
) -> list[int]:
    """Indices of controls that turn in a space of their own, or are constrained; sentences on all others."""
    paths = (held_controls.BONE_PATH.match(one.data_path) for one in held_controls.drivers(armature_object))
    driven = {bpy.utils.unescape_identifier(path[1]) for path in paths if path}
    kept = []
    for index, (plan, space) in enumerate(zip(planned, spaces, strict=True)):
        own = plan.name in driven or held_controls.active_constraints(armature_object.pose.bones[plan.name])
        if plan.kind is ControlKind.POLE or own or space.residual_rad < NOTICEABLE_RAD:
            kept.append(index)
        else:
            notes.append(
                f"Bone '{plan.name}' hangs on something that moves by itself, such as inverse "
                "kinematics, and is not keyed; name its control in the character map"
            )
    return kept


def _on_goals(
    armature_object: Object, planned: Sequence[PlannedControl], spaces: Sequence[ControlSpace]
) -> list[ControlSpace]:
    """The spaces with fingers on the goals of hands that are keyed by these alone: they were probed in FK."""
    found = list(spaces)
    turning = {plan.bone for plan in planned if plan.kind in control_channels.IN_FK}
    for index, (plan, space) in enumerate(zip(planned, spaces, strict=True)):
        on_finger = (
            space.turner != control_channels.NOTHING and planned[space.turner].kind is ControlKind.FINGER
        )
        if plan.kind is not ControlKind.FINGER or on_finger:
            continue
        for at, goal in enumerate(planned):
            if goal.kind is ControlKind.GOAL and goal.limb == plan.limb and goal.bone not in turning:
                on, own = _rests(armature_object, [goal.name, plan.name])
                rest = np.linalg.inv(on) @ own
                placed = replace(space, turner=at, turn=rest[:3, :3])
                found[index] = placed.placed_by_turner(rest[:3, 3])
    return found


def _placed(armature_object: Object, control: Control, controls: Sequence[Control], size: float) -> Control:
    """A control that random poses did not place: where it rests on what turns it, else where it is."""
    space = control.space
    if control.plan.kind in control_channels.ALWAYS_MOVED or space.residual < control_channels.RIGID * size:
        return control
    if space.turner != control_channels.NOTHING and space.residual_rad < NOTICEABLE_RAD:
        turner, own = _rests(armature_object, [controls[space.turner].name, control.name])
        return replace(control, space=space.placed_by_turner((np.linalg.inv(turner) @ own)[:3, 3]))
    return replace(control, space=replace(space, axes=np.zeros((3, 3))))
