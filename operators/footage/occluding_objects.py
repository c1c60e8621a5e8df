"""Objects in front of the footage, which is the background of the camera's view."""

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from ...core.text import Sentence
from ..shell.messages import warn
from ..shell.notices import give_notices

SOLID_TYPES = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}
TRANSPARENT_DISPLAYS = {"WIRE", "BOUNDS"}
MOST_NAMED = 3
"""Most objects in front of the footage that are named."""


def occluding_objects(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> list[str]:
    """Return the names of the visible solid objects in the camera's picture, except the actors' own."""
    scene, camera = context.scene, take.camera
    if camera is None:
        return []
    actors = {other.armature for other in scene.keymark.takes}
    return [
        each.name
        for each in context.view_layer.objects
        if each.type in SOLID_TYPES
        and each.display_type not in TRANSPARENT_DISPLAYS
        and (each.parent is None or each.parent not in actors)
        and each.visible_get()
        and _in_picture(scene, camera, each)
    ]


def warn_of_occluders(
    operator: bpy.types.Operator, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Report what hides the footage and keep it as a notice, or take back what an earlier notice said."""
    occluding = occluding_objects(context, take)
    if not occluding:
        give_notices(take, "footage", "view")
        return
    sentence = Sentence(
        "In front of the footage: {names}; to see the performer, select what hides them and "
        "press H (Alt H brings it back)",
        names=", ".join(occluding[:MOST_NAMED] + (["..."] if len(occluding) > MOST_NAMED else [])),
    )
    give_notices(take, "footage", "view", (warn(operator, sentence),), occluding)


def _in_picture(scene: bpy.types.Scene, camera: bpy.types.Object, blender_object: bpy.types.Object) -> bool:
    """Whether the corners of an object's bounding box in front of the camera span part of the picture."""
    corners = [
        world_to_camera_view(scene, camera, blender_object.matrix_world @ Vector(corner))
        for corner in blender_object.bound_box
    ]
    in_front = [corner for corner in corners if corner.z > 0.0]
    return bool(in_front) and all(
        min(corner[axis] for corner in in_front) < 1.0 and max(corner[axis] for corner in in_front) > 0.0
        for axis in (0, 1)
    )
