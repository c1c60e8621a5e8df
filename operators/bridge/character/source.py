"""The motion that a character is to perform: an Action of a Keymark actor, hands and feet included."""

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.body.extremities import Extremities, extremity_names
from ....core.body.human import HUMAN
from ....core.body.segment_motion import SegmentMotion, segment_motion
from ....core.finish.natural_extremities import natural_extremities
from ....core.finish.rig import Rig, RigPose
from ....core.progress import Job, Progress, within
from ..actions import existing_channelbag
from ..actor_lengths import read_body
from ..final_motion import motion_frames, read_values, shown_postures
from ..rig import read_rig
from ..rotation_modes import ALL_PATHS, bone_path

READ, SEEN = 0.7, 0.8
"""Shares of the job at which the curves are read, and their postures known."""


def read_source(
    armature_object: bpy.types.Object, action: bpy.types.Action
) -> Job[tuple[SegmentMotion, Array]]:
    """The motion that an Action holds for an actor, in the time of the actor's scene.

    Hands and feet are as keyed; those without keys as the motion alone would turn them.

    Yields:
        Progress; nothing in Blender is changed.

    Returns:
        The motion of F frames, and their scene frames (F,).

    Raises:
        InputError: The armature is not an actor's, or the Action holds no motion of it.
    """
    body = read_body(armature_object, HUMAN)
    keyed = _keyed_extremities(armature_object, action)
    rig = read_rig(armature_object, body, keyed)
    frames = motion_frames(armature_object, action, body)
    reading = read_values(armature_object, action, rig, frames)
    values = yield from within("Reading the motion", reading, 0.0, READ)
    shown = rig.pose(values)
    posture = shown_postures(armature_object, rig, shown, body)
    yield Progress("Reading the motion", SEEN)
    scene = next(iter(armature_object.users_scene), bpy.context.scene)
    time_s = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
    natural = natural_extremities(body, posture, time_s).without(keyed)
    turns = {name: _turn(rig, shown, name) for name in keyed}
    extremities = Extremities({**natural.turns, **turns})
    return segment_motion(body, posture, np.asarray(time_s), extremities), frames


def _keyed_extremities(armature_object: bpy.types.Object, action: bpy.types.Action) -> tuple[str, ...]:
    """Names of the hands and feet that an Action turns."""
    channelbag = existing_channelbag(action, armature_object)
    curves = channelbag.fcurves if channelbag is not None else ()
    keyed = {curve.data_path for curve in curves if not curve.mute and not curve.is_empty}
    return tuple(
        name
        for name in extremity_names(HUMAN)
        if any(bone_path(name, channel) in keyed for channel in ALL_PATHS)
    )


def _turn(rig: Rig, shown: RigPose, name: str) -> Array:
    """(F, 3, 3) the turn of a hand or foot in its parent's frame."""
    index = next(number for number, bone in enumerate(rig.bones) if bone.name == name)
    return shown.local(rig, index, slice(None))
