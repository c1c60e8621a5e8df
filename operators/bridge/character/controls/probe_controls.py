"""Find out how a character's controls act: pose them at random for a moment, and see what moves what."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

from .....core.arrays import Array
from .....core.retarget.controls.control_channels import ALWAYS_MOVED, Control, ordered_controls
from .....core.retarget.controls.control_plan import ControlKind, PlannedControl
from .....core.retarget.controls.control_spaces import ControlSpace, PosedControls, chosen, find_spaces
from .....core.retarget.controls.control_targets import PoleSetting
from .....core.retarget.controls.rigid_offset import rigid_offset
from .....core.retarget.maps.character_map import CharacterMap
from .....core.text import Sentence
from ..pose_scales import ONE, scaled_bones
from .dependencies import active_constraints, driven_bone, drivers
from .posing import posing, set_properties
from .probe_ik import try_inverse_kinematics
from .random_poses import RandomPoses, pose_at_random
from .shown_properties import probed_properties

STILL, MOVED = 3, 4
"""Poses at random, without and with locations."""
TURN_RAD = 0.4
"""Standard deviation of random turns about each axis."""
MOVE_SHARE = 0.1
"""Standard deviation of random locations, in sizes of the character."""
DISPLACED = 1e-5
"""Location of a control that counts as one, in sizes of the character."""
FOLLOWS_RAD, FOLLOWS = 0.02, 0.01
"""Turn, and distance in sizes, up to which a bone follows its control as it was seen to; else as at rest."""
NOTICEABLE_RAD, NOTICEABLE = 0.3, 0.05
"""Turn, and distance in sizes, by which a bone may fail to follow its control before a note is made."""


@dataclass(frozen=True, eq=False)
class ProbedControls:
    """A character's controls, and how the bones with roles follow them."""

    controls: tuple[Control, ...]
    """Those that turn or carry others first."""
    offsets: Mapping[str, Array]
    """(4, 4) by control the pose of its bone in its own axes."""
    poles: Mapping[str, PoleSetting]
    """By pole where it belongs."""
    size: float
    """The character's, in the armature's units."""
    notes: tuple[str, ...]


def probe_controls(
    armature_object: bpy.types.Object, character_map: CharacterMap, planned: Sequence[PlannedControl]
) -> ProbedControls:
    """How the planned controls act; afterwards everything is as it was.

    Args:
        armature_object: A character that `require_character` accepts.
        character_map: Its map; settings and switches are set as the motion will have them.
        planned: The controls.
    """
    size = character_size(armature_object, character_map)
    notes: list[str] = []
    in_fk, in_ik = (probed_properties(character_map, in_ik) for in_ik in (False, True))
    displaced = _displaced(armature_object, planned, size)
    with posing(armature_object, list(in_fk)):
        set_properties(armature_object, in_fk)
        for name in scaled_bones(armature_object, [plan.name for plan in planned]):
            armature_object.pose.bones[name].scale = ONE
        names, bones = [plan.name for plan in planned], [plan.bone for plan in planned]
        poses = RandomPoses(STILL, MOVED, TURN_RAD, MOVE_SHARE * size)
        channels, shown, followed = pose_at_random(armature_object, names, bones, poses)
        posed = PosedControls(channels, shown, STILL)
        kept = _steady(armature_object, planned, find_spaces(posed), notes)
        posed, followed = chosen(posed, kept), followed[:, kept]
        planned = [planned[index] for index in kept]
        controls = ordered_controls(
            [
                Control(
                    plan,
                    armature_object.pose.bones[plan.name].rotation_mode,
                    space,
                    turns=plan.kind is not ControlKind.POLE,
                    displaced=plan.name in displaced,
                )
                for plan, space in zip(planned, find_spaces(posed), strict=True)
            ]
        )
        offsets = _fk_offsets(armature_object, posed, followed, planned, size, notes)
        ik = try_inverse_kinematics(armature_object, character_map, controls, size, in_ik)
    controls = tuple(_placed(control, ik.places, size) for control in controls)
    return ProbedControls(controls, offsets | dict(ik.offsets), ik.poles, size, (*notes, *ik.notes))


def character_size(armature_object: bpy.types.Object, character_map: CharacterMap) -> float:
    """Largest extent of the bones with roles at rest, in the armature's units."""
    bones = armature_object.data.bones
    names = [name for role in character_map.roles for name in character_map.bones(role)]
    heads = np.array([bones[name].head_local for name in names], dtype=np.float64)
    return float(np.ptp(heads, axis=0).max())


def _displaced(armature_object: bpy.types.Object, planned: Sequence[PlannedControl], size: float) -> set[str]:
    """The controls that have a location now."""
    bones = armature_object.pose.bones
    return {plan.name for plan in planned if bones[plan.name].location.length > DISPLACED * size}


def _fk_offsets(
    armature_object: bpy.types.Object,
    posed: PosedControls,
    bones: Array,
    planned: Sequence[PlannedControl],
    size: float,
    notes: list[str],
) -> dict[str, Array]:
    """How bones follow their controls while all limbs show FK; sentences on those that do not are added."""
    offsets = {}
    for index, plan in enumerate(planned):
        if plan.kind not in (ControlKind.FK, ControlKind.HIPS):
            continue
        # Locations of other controls may stretch what lies between: only the first poses count.
        offset, turn_rad, distance = rigid_offset(
            posed.poses[: posed.still, index], bones[: posed.still, index]
        )
        if turn_rad > FOLLOWS_RAD or distance > FOLLOWS * size:
            offset = _offset_at_rest(armature_object, plan)
        offsets[plan.name] = offset
        if turn_rad > NOTICEABLE_RAD or distance > NOTICEABLE * size:
            notes.append(
                Sentence(
                    "Bone '{bone}' does not follow its control '{control}' rigidly; its poses may be off",
                    bone=plan.bone,
                    control=plan.name,
                )
            )
    return offsets


def _offset_at_rest(armature_object: bpy.types.Object, plan: PlannedControl) -> Array:
    """(4, 4) the rest pose of a control's bone in the control's own axes."""
    control, bone = (
        np.array(armature_object.data.bones[name].matrix_local, dtype=np.float64)
        for name in (plan.name, plan.bone)
    )
    return np.linalg.inv(control) @ bone


def _steady(
    armature_object: bpy.types.Object,
    planned: Sequence[PlannedControl],
    spaces: Sequence[ControlSpace],
    notes: list[str],
) -> list[int]:
    """Indices of the controls whose rotations act in a space of their own, or that constraints keep from it.

    The others are carried by something that moves and is not keyed, so that no key would show as it should;
    sentences on them are added.
    """
    driven = {driven_bone(driver.data_path) for driver in drivers(armature_object)}
    kept = []
    for index, (plan, space) in enumerate(zip(planned, spaces, strict=True)):
        own = plan.name in driven or active_constraints(armature_object.pose.bones[plan.name])
        if plan.kind is ControlKind.POLE or own or space.residual_rad < NOTICEABLE_RAD:
            kept.append(index)
        else:
            notes.append(
                Sentence(
                    "Bone '{bone}' hangs on something that moves by itself, such as inverse kinematics, and "
                    "is not keyed; name its control in the character map",
                    bone=plan.name,
                )
            )
    return kept


def _placed(control: Control, places: Mapping[str, Array], size: float) -> Control:
    """A control that random poses did not place, where a limb within reach shows its place."""
    space = control.space
    if control.plan.kind in ALWAYS_MOVED or space.is_placed(size):
        return control
    if control.name in places and space.residual_rad < NOTICEABLE_RAD:
        return replace(control, space=space.placed_by_turner(places[control.name]))
    return replace(control, space=replace(space, axes=np.zeros((3, 3))))
