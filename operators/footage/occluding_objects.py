"""What stands between a camera and the footage behind everything."""

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

SOLID = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}
SEEN_THROUGH = {"WIRE", "BOUNDS"}


def names_in_the_way(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> list[str]:
    """Names of the visible solid objects that cover some of the camera's picture; none of the actors' own."""
    scene, camera = context.scene, take.camera
    if camera is None:
        return []
    actors = {other.armature for other in scene.keymark.takes}
    return [
        each.name
        for each in context.view_layer.objects
        if each.type in SOLID
        and each.display_type not in SEEN_THROUGH
        and (each.parent is None or each.parent not in actors)
        and each.visible_get()
        and _covers(scene, camera, each)
    ]


def _covers(scene: bpy.types.Scene, camera: bpy.types.Object, blender_object: bpy.types.Object) -> bool:
    """Whether what is in front of the camera of an object's bounding box lies in the picture in part."""
    corners = [
        world_to_camera_view(scene, camera, blender_object.matrix_world @ Vector(corner))
        for corner in blender_object.bound_box
    ]
    before = [corner for corner in corners if corner.z > 0.0]
    return bool(before) and all(
        min(corner[axis] for corner in before) < 1.0 and max(corner[axis] for corner in before) > 0.0
        for axis in (0, 1)
    )
