"""Adding an actor to a scene the way Blender adds objects: selected, active, and known to the panel."""

import bpy

from ...core.body.kinematics import Body
from ..bridge.armature import build_armature
from .properties import length_names, length_property

EVEN_M = 5e-4
"""Left and right count as equally long within this."""


def add_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, body: Body) -> bpy.types.Object:
    """Build the armature, named after the take; it becomes its actor, without keyframes or motion yet."""
    scene, layer = context.scene, context.view_layer
    if layer.objects.active is not None and layer.objects.active.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for selected in list(layer.objects.selected):
        selected.select_set(False, view_layer=layer)
    armature_object = build_armature(scene, body, f"{take.name} Actor")
    armature_object.select_set(True, view_layer=layer)
    layer.objects.active = armature_object
    take.armature = armature_object
    take.keyframe_action = take.motion_action = None
    show_lengths(take, body)
    return armature_object


def show_lengths(take: bpy.types.PropertyGroup, body: Body) -> None:
    """Let the panel show a body's lengths."""
    segments = body.actor.segments_m
    lengths = take.lengths
    pairs = [(f"{part}.L", f"{part}.R") for part in {name.split(".")[0] for name in segments if "." in name}]
    lengths.symmetric = all(abs(segments[left] - segments[right]) < EVEN_M for left, right in pairs)
    for name in length_names():
        setattr(lengths, length_property(name), segments[name])
