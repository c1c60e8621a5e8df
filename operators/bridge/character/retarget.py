"""An actor's motion put onto a character: its map is completed, the motion solved, keyed and measured."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, Object, Scene

from ....core.arrays import Array
from ....core.body.fingers import finger_flexions
from ....core.body.kinematics import Extremities, SegmentMotion, segment_motion
from ....core.errors import InputError
from ....core.estimate.notes import of_true_causes
from ....core.feet.ground import IN_FLOOR_M, floor_notes
from ....core.feet.natural_extremities import natural_extremities
from ....core.files.paths import absolute_path, real_path
from ....core.progress import Job, Progress, run, stretch, within
from ....core.retarget.character import FINGER_ROLES, Character
from ....core.retarget.character_motion import CharacterMotion, find_stance
from ....core.retarget.controls.control_channels import ControlKind, limb_keys, planned_controls
from ....core.retarget.controls.control_motion import ControlMotion, dense_controls, on_controls
from ....core.retarget.controls.point_tolerances import ToleranceRules
from ....core.retarget.controls.reduction import reduce_controls
from ....core.retarget.maps.character_map import CharacterMap, Setting, Switch
from ....core.retarget.maps.map_registry import check_map
from ....core.retarget.quality import Measured, Quality, warnings_of
from ....core.retarget.recognition.recognize import find_root
from ....core.retarget.solve.feet import floor_lifts
from ....core.retarget.solve.solve_motion import solve_motion
from ....core.take.conversion_settings import LimbKeys, Placement, RetargetOptions
from ....core.take.motion import Motion
from ..actions import assign_action, curves_of
from ..actor_bones import object_space
from ..armature import read_body
from ..blend_files import check_blend, load_blocks
from ..fcurves import EXTREMITIES
from ..footage import set_scene_range
from ..result_files import set_look
from ..rig import present_frames, read_rig, read_values, shown_postures
from ..rotation_modes import ALL_PATHS, bone_path, rotation_values
from ..scene_frames import scene_frames
from . import write_retargeted
from .held_controls import Value, keyed_values, switch_values
from .measure import measure, mesh_soles
from .probe_controls import ProbedControls, probe_controls
from .read_character import read_character
from .write_retargeted import RetargetedKeys, write_keys

READ, SEEN = 0.7, 0.8  # shares of the job at which the curves are read, and their postures known


def read_source(armature_object: Object, action: Action) -> Job[tuple[SegmentMotion, Array]]:
    """An actor's motion in an Action, hands and feet as keyed or else natural, and its frames (F,)."""
    body, curves = read_body(armature_object), curves_of(action, armature_object)
    paths = {path for (path, _), curve in curves.items() if not curve.mute and not curve.is_empty}
    keyed = tuple(name for name in EXTREMITIES if any(bone_path(name, one) in paths for one in ALL_PATHS))
    rig = read_rig(armature_object, body, keyed)
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    rate = scene.render.fps / scene.render.fps_base
    frames = present_frames(armature_object, action, rate)
    reading = read_values(armature_object, action, rig, frames)
    values = yield from within("Reading the motion", reading, 0.0, READ)
    shown = rig.pose(values)
    posture = shown_postures(rig, shown, body)
    yield Progress("Reading the motion", SEEN)
    time_s = (frames - frames[0]) / rate
    natural = natural_extremities(body, posture, time_s).without(keyed)
    index = {bone.name: number for number, bone in enumerate(rig.bones)}
    turns = {name: shown.local(rig, index[name], slice(None)) for name in keyed}
    extremities = Extremities({**natural.turns, **turns})
    segments = segment_motion(body, posture, np.asarray(time_s), extremities)
    return replace(segments, fingers=finger_flexions(turns)), frames


def show_result(scene: Scene, blend: Path | None, motion: Motion, notes: list[str] | None = None) -> Array:
    """Show a result's footage behind its camera, with rate, range and look; returns the scene frames (F,).

    Without a .blend, which Blender must be able to read, the scene gets rate and range alone. A clip that is
    not where it says is looked for beside it; the scene has none where it is nowhere, and `notes` a sentence.
    """
    set_scene_range(scene, (1920, 1080), motion.fps, motion.frame_start, len(motion.time_s))
    set_look(scene)
    shown = None
    if blend is not None:
        check_blend(blend, "a result")
        scenes = load_blocks(blend, "scenes", "convert the take again, or name its motion.json instead", list)
        shown = next((one for one in scenes if one.camera and one.active_clip), None)
    if blend is not None and shown is not None:
        clip = shown.active_clip
        for name in ("resolution_x", "resolution_y", "resolution_percentage", "fps", "fps_base"):
            setattr(scene.render, name, getattr(shown.render, name))
        scene.collection.objects.link(shown.camera)
        scene.camera = shown.camera
        file, folder = Path(bpy.path.abspath(clip.filepath)), absolute_path(blend).parent
        names = (Path(file.name), Path(file.parent.name, file.name))  # the latter of an image sequence
        places = (file, *(above / name for above in (folder, folder.parent) for name in names))
        found = next((place for place in places if place.is_file()), None)
        if found is None:
            shown.camera.data.background_images.clear()
            bpy.data.movieclips.remove(clip)
            if notes is not None:
                where = f"neither where it was nor beside {blend.name}"
                notes.append(f"the footage {file.name} is {where}, and is not shown")
        else:
            clip.filepath = clip.filepath if found == file else str(real_path(found))
            scene.active_clip = clip
    rate = scene.render.fps / scene.render.fps_base
    frames = scene_frames(motion.time_s, motion.frame_start, rate)
    scene.frame_start = motion.frame_start
    scene.frame_end = max(scene.frame_start + len(frames) - 1, int(np.floor(frames[-1])))
    return frames


def complete_map(
    armature_object: Object, character: Character, character_map: CharacterMap
) -> tuple[CharacterMap, tuple[str, ...]]:
    """Add to a map what only Blender knows, and leave out properties that the rig lacks, which notes name."""
    lacking: list[Setting | Switch] = []

    def there(one: Setting | Switch) -> bool:
        if isinstance(armature_object.pose.bones[one.bone].get(one.property), int | float):
            return True
        lacking.append(one)
        return False

    completed = replace(
        character_map,
        settings=tuple(filter(there, character_map.settings)),
        ik={
            limb: own if own.switch is None or there(own.switch) else replace(own, switch=None)
            for limb, own in character_map.ik.items()
        },
    )
    notes = tuple(
        f"Bone '{one.bone}' has no property '{one.property}' that could be keyed; the rig may be of another "
        f"version than the map '{character_map.title}'"
        for one in lacking
    )
    if completed.root is None:
        up = find_stance(character, completed)[2]
        completed = replace(completed, root=find_root(character, completed, up))
    if not completed.soles:
        completed = replace(completed, soles=mesh_soles(armature_object, character, completed))
    return completed, notes


SOLVED, PROBED, FIRST = 0.25, 0.3, 0.8
"""Shares of the job at which the motion is solved, controls are known, and keys are found and measured."""
LIFTINGS = ((FIRST, 0.9), (0.9, 1.0))  # the same of the times that feet are lifted, where they must be
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

    def write(self, scene: Scene, action: Action | str) -> Action:
        """Write the motion into a new Action of a name, or one retargeted before, and assign it."""
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
    armature_object: Object,
    source: SegmentMotion,
    scene_frames: Array,
    character_map: CharacterMap,
    options: RetargetOptions,
) -> Job[Retargeted]:
    """Retarget a motion of F > 1 frames to a character at rising scene frames (F,); nothing stays changed."""
    yield Progress("Reading the character", 0.0)
    if len(scene_frames) < 2:
        raise InputError("the motion has a single frame; choose one of two frames or more")
    character = read_character(armature_object)
    check_map(character_map, character)
    there = object_space(armature_object)
    if options.place is Placement.PERFORMER:
        write_retargeted.require_placeable(armature_object)
    character_map, lacking = complete_map(armature_object, character, character_map)
    unknown = [role for role in FINGER_ROLES if role in character_map.roles and role not in source.fingers]
    alone = tuple(dict.fromkeys((*character_map.left_alone, *unknown)))
    character_map = replace(character_map, left_alone=alone)
    motion = yield from stretch(solve_motion(character, character_map, source, options, there), 0.0, SOLVED)
    yield Progress("Finding how the controls act", SOLVED)
    planned = planned_controls(character_map, options, character)
    planned = tuple(plan for plan in planned if plan.kind is not ControlKind.ROOT or motion.root is not None)
    probed = probe_controls(armature_object, character_map, planned)
    above = write_retargeted.carriers(armature_object, scene_frames)
    performance = _Performance(
        armature_object, character, character_map, source, scene_frames, options, above, probed
    )
    keys, controls, found = yield from stretch(performance.keyed(motion), PROBED, FIRST)
    lifts: dict[str, Array] = {}
    for start, end in LIFTINGS:
        more = performance.lifts(motion, found.depth_m)
        if not more:
            break
        lifts = {limb: own + lifts.get(limb, 0.0) for limb, own in more.items()}
        yield Progress("Lifting the feet out of the floor", start)
        motion = run(solve_motion(character, character_map, source, options, there, lifts))
        keys, controls, found = yield from stretch(performance.keyed(motion), start, end)
    warnings = warnings_of(found.quality.to_dict(), motion.size)
    if probed.releases.stuck and warnings:
        bone, name = probed.releases.stuck[0]
        raise InputError(
            f"bone '{bone}' of '{armature_object.name}' is held by its constraint '{name}', whose influence "
            f"has a driver ({warnings[0]}); mute the constraint, or name its switch in the character map"
        )
    notes = (*motion.notes, *lacking, *probed.notes)
    notes += write_retargeted.channel_notes(
        armature_object, keys.controls, controls, keys.scaled, probed.releases
    )
    if len(above) > 1:
        how = "its place is keyed against it on every frame" if keys.placement else "the motion rides on it"
        carrier = armature_object.parent.name
        notes += (f"'{armature_object.name}' hangs on '{carrier}', which moves: {how}",)
    sides = {limb[-1]: depth for limb, depth in found.depth_m.items()}
    notes += floor_notes(sides, scene_frames, f" of '{character.name}'", motion.size)
    keyed = [values for one in keys.controls for values in one.values]
    count, dense = sum(one.size for one in keyed), sum(one.shape[1] for one in keyed) * len(scene_frames)
    quality = replace(found.quality, keys=count, dense_keys=dense)
    uid = armature_object.session_uid
    notes = of_true_causes(notes)
    return Retargeted(uid, character, character_map, options, motion, keys, quality, notes)


@dataclass(frozen=True, eq=False)
class _Performance:
    """What stays the same while a motion is brought onto a character, once or again with lifted feet."""

    armature_object: Object
    character: Character
    character_map: CharacterMap
    source: SegmentMotion
    scene_frames: Array
    options: RetargetOptions
    above: Array  # (F, 4, 4) what carries the armature, (1, 4, 4) if it is still
    probed: ProbedControls

    def keyed(self, motion: CharacterMotion) -> Job[tuple[RetargetedKeys, ControlMotion, Measured]]:
        """A solved motion as keys, and what is measured of them as Blender shows them."""
        armature_object, options, probed = self.armature_object, self.options, self.probed
        character, character_map, frames = self.character, self.character_map, self.scene_frames
        yield Progress("Bringing the motion onto the controls", 0.0)
        how = (probed.controls, probed.offsets, probed.poles, probed.size)
        controls = on_controls(character, character_map, motion, *how)
        write_retargeted.require_placed_hips(armature_object, controls)
        yield Progress("Finding the keys", 0.0)
        if options.tolerance_m is None:
            keyed = dense_controls(controls, rotation_values)
        else:
            rules = ToleranceRules(motion, self.source.time_s, motion.stance[2], options.tolerance_m)
            reducing = reduce_controls(controls, frames, rules, rotation_values)
            keyed = yield from within("Finding the keys", reducing, 0.0, REDUCED)

        def shown(limb: str, switch: Switch) -> Value:
            """A switch's value as the options want its limb to be shown."""
            return switch.fk if limb_keys(character_map, options, limb) is LimbKeys.FK else switch.ik

        def in_fk(limb: str, switch: Switch) -> Value | None:
            """The value with which a limb that is keyed in both ways shows FK; None for others."""
            return switch.fk if limb_keys(character_map, options, limb) is LimbKeys.BOTH else None

        placed = options.place is Placement.PERFORMER
        keys = RetargetedKeys(
            frames,
            keyed,
            keyed_values(character_map, shown) | dict(probed.releases.switches),
            write_retargeted.placement_keys(armature_object, self.above, motion.to_world) if placed else (),
            write_retargeted.scaled_bones(armature_object, (one.control.name for one in keyed)),
            probed.releases.constraints,
        )
        yield Progress("Measuring the character", REDUCED)
        action = bpy.data.actions.new("Keymark Measuring")
        try:
            write_keys(keys, armature_object, action)
            measuring = measure(
                armature_object,
                action,
                frames,
                self.source,
                motion,
                character,
                character_map,
                list(keys.properties),
                switch_values(character_map, in_fk),
                rides=not placed and len(self.above) > 1,
            )
            measured = yield from within("Measuring the character", measuring, REDUCED, 1.0)
        finally:
            bpy.data.actions.remove(action)
        return keys, controls, measured

    def lifts(self, motion: CharacterMotion, depth_m: Mapping[str, Array]) -> dict[str, Array]:
        """(F,) by leg how much higher a foot in the floor must be [m]; none where all feet are out of it."""
        most_m = motion.size * IN_FLOOR_M
        if not self.options.plant_feet or not any((depth > most_m).any() for depth in depth_m.values()):
            return {}
        rests = [(rest.leg, (rest.first, rest.last)) for rest in motion.rests]
        time_s, spare_m = self.source.time_s, 0.5 * most_m  # which thinned keys may lower a foot again
        return {
            leg: floor_lifts(depth, [at for limb, at in rests if limb == leg], time_s, spare_m)
            for leg, depth in depth_m.items()
        }
