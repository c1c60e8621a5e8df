"""Retarget a motion to a character: solved, brought onto its controls, reduced to few keys."""

from dataclasses import dataclass

import bpy

from ....core.arrays import Array
from ....core.body.segment_motion import SegmentMotion
from ....core.errors import InputError
from ....core.progress import Job, Progress, stretch, within
from ....core.retarget.character import Character
from ....core.retarget.character_map import CharacterMap
from ....core.retarget.character_motion import CharacterMotion, Similarity
from ....core.retarget.control_channels import control_channels
from ....core.retarget.control_motion import ControlMotion, KeyedControl, dense_controls
from ....core.retarget.control_plan import ControlKind, limb_bones, limb_keys, planned_controls
from ....core.retarget.control_reduction import reduce_controls
from ....core.retarget.control_targets import control_targets
from ....core.retarget.held_points import held_points
from ....core.retarget.limb_paths import limb_paths
from ....core.retarget.options import LimbKeys, Placement, RetargetOptions
from ....core.retarget.point_tolerances import ToleranceRules
from ....core.retarget.roles import LIMBS
from ....core.retarget.solve.solve_motion import solve_motion
from ....core.retarget.stance import find_stance
from ..object_space import object_space
from ..rotation_modes import rotation_values
from .channel_notes import channel_notes
from .object_placement import PlacementKeys, placement_keys
from .posing import Property
from .probe_controls import ProbedControls, probe_controls
from .read_character import read_character
from .write_retargeted import write_retargeted

SOLVED, PROBED = 0.3, 0.35
"""Shares of the job at which the motion is solved, and the controls are known."""
STILL_FRAMES = 2
"""Fewest frames that a motion has."""


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A character's motion, not yet written."""

    session_uid: int
    """Blender's number of the armature object in this session."""
    character: Character
    character_map: CharacterMap
    """The map, completed."""
    options: RetargetOptions
    frames: Array
    """(F,) scene frames."""
    motion: CharacterMotion
    keyed: tuple[KeyedControl, ...]
    properties: dict[Property, float | int | bool]
    """Custom properties that are keyed at the first frame."""
    placement: PlacementKeys
    """The object's channels that are keyed at the first frame."""
    notes: tuple[str, ...]

    @property
    def keys_before(self) -> int:
        """Number of keys with one on every frame."""
        return sum(held.channel_count for held in self.keyed) * len(self.frames)

    def write(self, scene: bpy.types.Scene, action: bpy.types.Action | str) -> bpy.types.Action:
        """Write the motion into an Action, and let it animate the character.

        Args:
            scene: The scene, which shows the character's new pose.
            action: The name of a new Action; or an Action, in which what an earlier retargeting made for the
                character is replaced.

        Raises:
            InputError: The character has been deleted meanwhile.
        """
        return write_retargeted(self, scene, action)


def retarget(
    armature_object: bpy.types.Object,
    source: SegmentMotion,
    scene_frames: Array,
    character_map: CharacterMap,
    options: RetargetOptions,
) -> Job[Retargeted]:
    """Retarget a motion to a character.

    Args:
        armature_object: The character's armature.
        source: The performer's motion, F frames.
        scene_frames: (F,) the scene frames that show it, rising.
        character_map: Which bones and controls play which role.
        options: What a person chose.

    Yields:
        Progress; nothing in Blender stays changed.

    Raises:
        InputError: The armature cannot be retargeted, the map does not fit it, or the motion has one frame.
    """
    yield Progress("Reading the character", 0.0)
    if len(scene_frames) < STILL_FRAMES:
        raise InputError("the motion has a single frame; choose one of two frames or more")
    character = read_character(armature_object)
    space = object_space(armature_object)
    here = Similarity(space.rotation, space.location, space.scale)
    motion = yield from stretch(solve_motion(character, character_map, source, options, here), 0.0, SOLVED)
    yield Progress("Finding how the controls act", SOLVED)
    planned = tuple(
        plan
        for plan in planned_controls(character_map, options)
        if plan.kind is not ControlKind.ROOT or motion.root is not None
    )
    probed = probe_controls(armature_object, character_map, planned)
    yield Progress("Bringing the motion onto the controls", PROBED)
    controls = _on_controls(character, character_map, motion, probed)
    if options.tolerance_m is None:
        keyed = dense_controls(controls, rotation_values)
    else:
        up = find_stance(character, character_map)[2]
        rules = ToleranceRules(motion, source.time_s, up, options.tolerance_m)
        reducing = reduce_controls(controls, scene_frames, rules, rotation_values)
        keyed = yield from within("Finding the keys", reducing, PROBED, 1.0)
    notes = (*motion.notes, *probed.notes, *channel_notes(armature_object, keyed, controls))
    return Retargeted(
        armature_object.session_uid,
        character,
        character_map,
        options,
        scene_frames,
        motion,
        keyed,
        _properties(character_map, options),
        placement_keys(armature_object, motion.to_world) if options.placement is Placement.PERFORMER else (),
        notes,
    )


def _on_controls(
    character: Character,
    character_map: CharacterMap,
    motion: CharacterMotion,
    probed: ProbedControls,
) -> ControlMotion:
    """The motion on the controls, by channels for every frame."""
    planned = [control.plan for control in probed.controls]
    limbs = {limb: limb_bones(character_map, limb) for limb in {plan.limb for plan in planned} if limb}
    wanted = control_targets(planned, motion, probed.offsets, probed.poles, limbs)
    return ControlMotion(
        controls=probed.controls,
        channels=control_channels(probed.controls, wanted, probed.size),
        wanted=wanted,
        offsets=probed.offsets,
        points=held_points(character, character_map, motion.soles),
        bones=motion.poses,
        limbs=limb_paths(character, character_map, motion, probed.controls, probed.offsets, probed.poles),
        size=probed.size,
        scale=character.scale,
    )


def _properties(character_map: CharacterMap, options: RetargetOptions) -> dict[Property, float | int | bool]:
    """The map's settings, and its switches as the options want the limbs to be shown."""
    values: dict[Property, float | int | bool] = {
        (setting.bone, setting.property): setting.value for setting in character_map.settings
    }
    for limb in LIMBS:
        controls = character_map.ik.get(limb)
        if controls is not None and controls.switch is not None:
            switch, keys = controls.switch, limb_keys(character_map, options, limb)
            values[switch.bone, switch.property] = switch.fk if keys is LimbKeys.FK else switch.ik
    return values
