"""The picture of a character's motion: beside the footage, through its camera and from the side."""

import bpy

from ....core.arrays import Array, Image
from ....core.report.character_sheet import character_sheet
from ....core.report.contact_sheet import evenly_spaced_frames
from ....core.report.footage_frames import footage_frames
from ....core.retarget.figure_lines import figure_lines
from ....core.retarget.maps.character_map import CharacterMap
from ..camera_from_scene import read_camera
from ..footage import Footage
from ..scene_frames import at_scene_frame
from .figure import character_figure

MOST_FRAMES = 6


def character_picture(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    character_map: CharacterMap,
    frames: Array,
    floor_m: float,
) -> Image | None:
    """Draw a character that shows its motion in a scene with the footage; None where there is no footage.

    Args:
        scene: A scene with the footage's clip and camera; its current frame is as before afterwards.
        armature_object: The character, with the Action.
        character_map: Its map, for a character without a mesh.
        frames: (F,) scene frames of the motion, the clip's frames in order.
        floor_m: Height of the floor under the character in the world [m].

    Raises:
        InputError: The clip cannot be read.
    """
    if scene.active_clip is None or scene.camera is None:
        return None
    footage = Footage(scene, scene.active_clip, scene.camera)
    camera = read_camera(footage, frames)
    shown = evenly_spaced_frames(len(frames), MOST_FRAMES)
    lines = figure_lines(character_map)
    figures = {}
    with at_scene_frame(scene) as go_to:
        for index in shown:
            go_to(float(frames[index]))
            figures[index] = character_figure(armature_object, lines)
    images = footage_frames(footage.open(), shown)
    first = round(float(frames[0]))
    return character_sheet(armature_object.name, figures, camera, images, first, floor_m)
