"""A retargeted character as files: a .blend with everything in it, and exports."""

from collections.abc import Mapping
from pathlib import Path

import bpy

from ..actions import curve_digest
from ..blend_writer import write_blend
from ..export_formats import FORMATS
from ..motion_export import export_motion
from .import_character import ImportedCharacter


def write_character_files(
    scene: bpy.types.Scene,
    imported: ImportedCharacter,
    action: bpy.types.Action,
    blend: Path,
    exports: Mapping[str, Path],
) -> str:
    """Write a character with its Action.

    A failure may leave half a file at these paths: the caller passes a staging folder.

    Args:
        scene: The scene with the character, its camera and range.
        imported: The character, which the Action animates.
        action: The motion.
        blend: Path of the .blend; its folder exists.
        exports: Paths by name of a format of `export_formats.FORMATS`.

    Returns:
        SHA-256 of the Action's curves: files of one motion differ, their curves do not.

    Raises:
        ConversionError: Blender could not write a file.
    """
    scene.frame_set(scene.frame_start)
    write_blend(blend, {scene, *imported.texts}, path_remap="RELATIVE_ALL", fake_user=False)
    frames = (scene.frame_start, scene.frame_end)
    for name, path in exports.items():
        export_motion(scene, imported.armature, action, frames, FORMATS[name], path, along=imported.objects)
    return curve_digest(imported.armature)


def missing_exporter(name: str) -> str | None:
    """Why this Blender cannot write a format; None where it can."""
    return FORMATS[name].missing()
