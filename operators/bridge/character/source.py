"""The motion that a character is to perform: an Action of a Keymark actor, hands and feet included."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, Object, Scene

from ....core.arrays import Array
from ....core.body.fingers import finger_flexions
from ....core.body.kinematics import Extremities, SegmentMotion, segment_motion
from ....core.feet.natural_extremities import natural_extremities
from ....core.files.paths import absolute_path, real_path
from ....core.progress import Job, Progress, within
from ....core.take.motion import Motion
from ..actions import curves_of
from ..actor_lengths import read_body
from ..blend_files import check_blend, load_blocks
from ..fcurves import EXTREMITIES
from ..footage import set_scene_range
from ..result_files import set_look
from ..rig import present_frames, read_rig, read_values, shown_postures
from ..rotation_modes import ALL_PATHS, bone_path
from ..scene_frames import scene_frames

READ, SEEN = 0.7, 0.8  # shares of the job at which the curves are read, and their postures known


def read_source(armature_object: Object, action: Action) -> Job[tuple[SegmentMotion, Array]]:
    """The motion that an Action holds for an actor, and its scene frames (F,); nothing in Blender is changed.

    Hands and feet are as keyed; those without keys as the motion alone would turn them. InputError where the
    armature is not an actor's, or the Action holds no motion of it.
    """
    body, curves = read_body(armature_object), curves_of(action, armature_object)
    paths = {path for (path, _), curve in curves.items() if not curve.mute and not curve.is_empty}
    keyed = tuple(
        name for name in EXTREMITIES if any(bone_path(name, channel) in paths for channel in ALL_PATHS)
    )
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
