"""Export of an actor's motion by Blender's own exporters; formats are listed in `export_formats`."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import bpy

from ...core.errors import ConversionError, InputError
from ...core.files.json_file import write_atomically
from .export_formats import ExportFormat
from .scene_frames import showing_action


def export_motion(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    frames: tuple[int, int],
    export_format: ExportFormat,
    path: Path,
    along: Sequence[bpy.types.Object] = (),
) -> None:
    """Write an actor's or a character's motion; scene, selection and frame are as before afterwards.

    Args:
        scene: The scene that holds the actor.
        armature_object: The actor.
        action: The motion.
        frames: First and last scene frame.
        export_format: The format to write.
        path: The file; it appears complete or not at all.
        along: Other objects that are written too, where the format has any; nothing else is.

    Raises:
        InputError: The actor is hidden with its collection.
        ConversionError: The exporter failed, or the file cannot be written.
    """
    with (
        _only(scene, armature_object, along),
        _frame_range(scene, frames),
        showing_action(armature_object, action),
    ):

        def write(beside: Path) -> None:
            try:
                export_format.write(armature_object, beside)
            except RuntimeError as error:
                raise ConversionError(f"{path}: the exporter failed ({str(error).strip()})") from error
            if not beside.exists():
                raise ConversionError(f"{path}: the exporter wrote nothing")

        write_atomically(path, write)


@contextmanager
def _frame_range(scene: bpy.types.Scene, frames: tuple[int, int]) -> Iterator[None]:
    """Set the scene's range to `frames`, without a preview range; then restore range and current frame."""
    names = ("frame_start", "frame_end", "use_preview_range")
    before = {name: getattr(scene, name) for name in names}
    at = scene.frame_current, scene.frame_subframe
    scene.frame_start, scene.frame_end, scene.use_preview_range = *frames, False
    try:
        yield
    finally:
        scene.use_preview_range = before["use_preview_range"]
        scene.frame_start, scene.frame_end = before["frame_start"], before["frame_end"]
        scene.frame_set(at[0], subframe=at[1])


@contextmanager
def _only(
    scene: bpy.types.Scene, chosen: bpy.types.Object, along: Sequence[bpy.types.Object]
) -> Iterator[None]:
    """Select some objects only and make one active, in object mode; then restore selection and mode."""
    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    active, hidden = layer.objects.active, chosen.hide_get(view_layer=layer)
    mode = active.mode if active is not None else "OBJECT"
    selected = [one for one in layer.objects if one.select_get(view_layer=layer)]
    try:
        _set_mode("OBJECT", mode)
        chosen.hide_set(False, view_layer=layer)
        if not chosen.visible_get(view_layer=layer):
            raise InputError(f"'{chosen.name}' is hidden with its collection; show it to export its motion")
        for one in selected:
            one.select_set(False, view_layer=layer)
        for one in (*along, chosen):
            one.select_set(True, view_layer=layer)
        layer.objects.active = chosen
        yield
    finally:
        for one in layer.objects:
            one.select_set(one in selected, view_layer=layer)
        chosen.hide_set(hidden, view_layer=layer)
        layer.objects.active = active
        _set_mode(mode, "OBJECT")


def _set_mode(mode: str, now: str) -> None:
    if mode != now and bpy.ops.object.mode_set.poll():
        bpy.ops.object.mode_set(mode=mode)
