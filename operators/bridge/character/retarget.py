"""Retarget a motion to a character: its map is completed, the motion solved, keyed and measured."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import bpy

from ....core.arrays import Array
from ....core.body.kinematics import SegmentMotion
from ....core.errors import InputError
from ....core.feet.ground import IN_FLOOR_M, floor_notes
from ....core.progress import Job, Progress, run, stretch, within
from ....core.retarget.character import FINGER_ROLES, Character
from ....core.retarget.character_motion import CharacterMotion, find_stance
from ....core.retarget.controls.control_motion import ControlMotion, KeyedControl, dense_controls
from ....core.retarget.controls.control_plan import ControlKind, limb_keys, planned_controls
from ....core.retarget.controls.control_targets import on_controls
from ....core.retarget.controls.point_tolerances import ToleranceRules
from ....core.retarget.controls.reduction import reduce_controls
from ....core.retarget.maps.character_map import CharacterMap, Setting, Switch
from ....core.retarget.maps.map_registry import check_map
from ....core.retarget.quality import Measured, Quality, warnings_of
from ....core.retarget.recognition.facing import find_root
from ....core.retarget.solve.feet import floor_lifts
from ....core.retarget.solve.solve_motion import solve_motion
from ....core.take.character_settings import LimbKeys, Placement, RetargetOptions
from ..actions import assign_action
from ..object_space import object_space
from ..rotation_modes import rotation_values
from .channel_notes import channel_notes, require_placed_hips
from .controls import Value, setting_values, switch_values
from .held_controls import require_released
from .measure import measure
from .mesh_soles import mesh_soles
from .probe_controls import ProbedControls, probe_controls
from .read_character import read_character
from .write_retargeted import (
    RetargetedKeys,
    carriers,
    placement_keys,
    require_placeable,
    scaled_bones,
    write_keys,
)


def complete_map(
    armature_object: bpy.types.Object, character: Character, character_map: CharacterMap
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Add to a map what only Blender knows, and leave out properties that the rig lacks, which notes name."""
    bones = armature_object.pose.bones

    def there(one: Setting | Switch) -> bool:
        return isinstance(bones[one.bone].get(one.property), int | float)

    used: list[Setting | Switch] = [*character_map.settings]
    used += [own.switch for own in character_map.ik.values() if own.switch is not None]
    notes = tuple(
        f"Bone '{one.bone}' has no property '{one.property}' that could be keyed; the rig may be of another "
        f"version than the map '{character_map.title}'"
        for one in used
        if not there(one)
    )
    completed = replace(
        character_map,
        settings=tuple(filter(there, character_map.settings)),
        ik={
            limb: own if own.switch is None or there(own.switch) else replace(own, switch=None)
            for limb, own in character_map.ik.items()
        },
    )
    if completed.root is None:
        up = find_stance(character, completed)[2]
        completed = replace(completed, root=find_root(character, completed, up))
    if not completed.soles:
        completed = replace(completed, soles=mesh_soles(armature_object, character, completed))
    return completed, notes


# --- Retarget a motion to a character


SOLVED, PROBED, FIRST = 0.25, 0.3, 0.8
"""Shares of the job at which the motion is solved, controls are known, and keys are found and measured."""
LIFTINGS = ((FIRST, 0.9), (0.9, 1.0))  # the same of the times that feet are lifted, where they must be
SPARE = 0.5  # of the depth that is allowed: so much farther feet are lifted, which thinned keys may lower
REDUCED = 0.7  # share of the latter at which the keys are found


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A character's motion, not yet written."""

    session_uid: int  # Blender's number of the armature object in this session
    character: Character
    character_map: CharacterMap  # the map, completed
    options: RetargetOptions
    motion: CharacterMotion
    keys: RetargetedKeys
    quality: Quality  # what was measured of the character as Blender shows it
    notes: tuple[str, ...]  # what a person should know, in sentences without a full stop

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which figures are out of bounds, in sentences without a full stop."""
        return warnings_of(self.quality.to_dict(), self.size)

    @property
    def size(self) -> float:
        """The character's size: its legs' length over the performer's."""
        return self.motion.size

    def write(self, scene: bpy.types.Scene, action: bpy.types.Action | str) -> bpy.types.Action:
        """Write the motion into a new Action of a name, or one that was retargeted before, and assign it.

        Raises:
            InputError: The character has been deleted meanwhile.
        """
        made = next((one for one in bpy.data.objects if one.session_uid == self.session_uid), None)
        if made is None:
            name = self.character.name
            raise InputError(f"armature '{name}' has been deleted meanwhile; nothing was changed")
        if isinstance(action, str):
            action = bpy.data.actions.new(action)
        write_keys(self.keys, made, action)
        action.use_fake_user = True
        assign_action(made, action)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        return action


def retarget(
    armature_object: bpy.types.Object,
    source: SegmentMotion,
    scene_frames: Array,
    character_map: CharacterMap,
    options: RetargetOptions,
) -> Job[Retargeted]:
    """Retarget a motion of F frames to a character, at rising scene frames (F,).

    Nothing in Blender stays changed.

    Raises:
        InputError: The armature cannot be retargeted, the map does not fit it, or the motion has one
            frame.
    """
    yield Progress("Reading the character", 0.0)
    if len(scene_frames) < 2:
        raise InputError("the motion has a single frame; choose one of two frames or more")
    character = read_character(armature_object)
    check_map(character_map, character)
    here = object_space(armature_object)
    placed = options.place is Placement.PERFORMER
    if placed:
        require_placeable(armature_object)
    character_map, lacking = complete_map(armature_object, character, character_map)
    unknown = [role for role in FINGER_ROLES if role in character_map.roles and role not in source.fingers]
    alone = tuple(dict.fromkeys((*character_map.left_alone, *unknown)))
    character_map = replace(character_map, left_alone=alone)
    motion = yield from stretch(solve_motion(character, character_map, source, options, here), 0.0, SOLVED)
    yield Progress("Finding how the controls act", SOLVED)
    probed = probe_controls(
        armature_object,
        character_map,
        tuple(
            plan
            for plan in planned_controls(character_map, options, character)
            if plan.kind is not ControlKind.ROOT or motion.root is not None
        ),
    )
    probed = replace(probed, notes=(*lacking, *probed.notes))
    above = carriers(armature_object, scene_frames)
    performance = _Performance(
        armature_object, character, character_map, source, scene_frames, options, above
    )
    keys, controls, found = yield from stretch(performance.keyed(motion, probed), PROBED, FIRST)
    lifts: dict[str, Array] = {}
    for start, end in LIFTINGS:
        more = performance.lifts(motion, found.depth_m)
        if not more:
            break
        lifts = {limb: own + lifts.get(limb, 0.0) for limb, own in more.items()}
        yield Progress("Lifting the feet out of the floor", start)
        motion = run(solve_motion(character, character_map, source, options, here, lifts))
        keys, controls, found = yield from stretch(performance.keyed(motion, probed), start, end)
    warnings = warnings_of(found.quality.to_dict(), motion.size)
    require_released(armature_object, probed.releases, warnings)
    sides = {limb[-1]: depth for limb, depth in found.depth_m.items()}
    return Retargeted(
        armature_object.session_uid,
        character,
        character_map,
        options,
        motion,
        keys,
        replace(found.quality, keys=keys.key_count, dense_keys=keys.dense_count),
        (
            *motion.notes,
            *probed.notes,
            *channel_notes(armature_object, keys.controls, controls, keys.scaled, probed.releases),
            *_carried_note(armature_object, above, placed),
            *floor_notes(sides, scene_frames, f" of '{character.name}'", motion.size),
        ),
    )


@dataclass(frozen=True, eq=False)
class _Performance:
    """What stays the same while a motion is brought onto a character, once or again with lifted feet."""

    armature_object: bpy.types.Object
    character: Character
    character_map: CharacterMap
    source: SegmentMotion
    scene_frames: Array
    options: RetargetOptions
    above: Array  # (F, 4, 4) what carries the armature, (1, 4, 4) if it is still

    def keyed(
        self, motion: CharacterMotion, probed: ProbedControls
    ) -> Job[tuple[RetargetedKeys, ControlMotion, Measured]]:
        """A solved motion as keys, and what is measured of them as Blender shows them."""
        armature_object, options = self.armature_object, self.options
        yield Progress("Bringing the motion onto the controls", 0.0)
        controls = on_controls(
            self.character,
            self.character_map,
            motion,
            probed.controls,
            probed.offsets,
            probed.poles,
            probed.size,
        )
        require_placed_hips(armature_object, controls)
        yield Progress("Finding the keys", 0.0)
        keyed = yield from _keyed(controls, motion, self.source, self.scene_frames, options)
        placed = options.place is Placement.PERFORMER
        keys = RetargetedKeys(
            self.scene_frames,
            keyed,
            setting_values(self.character_map)
            | switch_values(self.character_map, self._shown)
            | dict(probed.releases.switches),
            placement_keys(armature_object, self.above, motion.to_world) if placed else (),
            scaled_bones(armature_object, (one.control.name for one in keyed)),
            probed.releases.constraints,
        )
        yield Progress("Measuring the character", REDUCED)
        action = bpy.data.actions.new("Keymark Measuring")
        try:
            write_keys(keys, armature_object, action)
            measuring = measure(
                armature_object,
                action,
                self.scene_frames,
                self.source,
                motion,
                self.character,
                self.character_map,
                list(keys.properties),
                switch_values(self.character_map, self._in_fk),
                rides=not placed and len(self.above) > 1,
            )
            measured = yield from within("Measuring the character", measuring, REDUCED, 1.0)
        finally:
            bpy.data.actions.remove(action)
        return keys, controls, measured

    def _shown(self, limb: str, switch: Switch) -> Value:
        """A switch's value as the options want its limb to be shown."""
        return switch.fk if self._keys(limb) is LimbKeys.FK else switch.ik

    def _in_fk(self, limb: str, switch: Switch) -> Value | None:
        """The value with which a limb that is keyed in both ways shows FK; None for others."""
        return switch.fk if self._keys(limb) is LimbKeys.BOTH else None

    def _keys(self, limb: str) -> LimbKeys:
        return limb_keys(self.character_map, self.options, limb)

    def lifts(self, motion: CharacterMotion, depth_m: Mapping[str, Array]) -> dict[str, Array]:
        """(F,) by leg how much higher a foot in the floor must be [m]; none where all feet are out of it."""
        most_m = motion.size * IN_FLOOR_M
        if not self.options.plant_feet or not any((depth > most_m).any() for depth in depth_m.values()):
            return {}
        return {
            limb: floor_lifts(
                depth,
                [(rest.first, rest.last) for rest in motion.rests if rest.leg == limb],
                self.source.time_s,
                SPARE * most_m,
            )
            for limb, depth in depth_m.items()
        }


def _carried_note(armature_object: bpy.types.Object, above: Array, placed: bool) -> tuple[str, ...]:
    if len(above) == 1:
        return ()
    parent = armature_object.parent.name
    how = "its place is keyed against it on every frame" if placed else "the motion rides on it"
    return (f"'{armature_object.name}' hangs on '{parent}', which moves: {how}",)


def _keyed(
    controls: ControlMotion,
    motion: CharacterMotion,
    source: SegmentMotion,
    scene_frames: Array,
    options: RetargetOptions,
) -> Job[tuple[KeyedControl, ...]]:
    if options.tolerance_m is None:
        return dense_controls(controls, rotation_values)
    rules = ToleranceRules(motion, source.time_s, motion.stance[2], options.tolerance_m)
    reducing = reduce_controls(controls, scene_frames, rules, rotation_values)
    return (yield from within("Finding the keys", reducing, 0.0, REDUCED))
