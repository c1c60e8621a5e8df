"""Save a character's map as a file, to use it elsewhere and to share it."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.requirements import idle
from .characters import active_character
from .map_conversion import map_of
from .recognition import map_folders
from .requirements import recognized

SUFFIX = ".json"


class KEYMARK_OT_save_map(BaseOperator, bpy.types.Operator):
    """Save which bones play which role as a file; in the folder that is offered it is found again"""

    bl_idname = "keymark.save_map"
    bl_label = "Save Map"
    bl_options = {"REGISTER"}
    requirements = (recognized, idle)

    filepath: bpy.props.StringProperty(name="File", description="File to write", subtype="FILE_PATH")
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN"})
    filter_glob: bpy.props.StringProperty(default=f"*{SUFFIX}", options={"HIDDEN"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file, in the user's own folder."""
        from ...core.retarget.maps.map_registry import map_path

        with reported(self):
            title = _title(active_character(context.scene))
            self.filepath = str(map_path(map_folders()[0], title))
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def check(self, context: bpy.types.Context) -> bool:
        """Give the file's name its suffix."""
        path = bpy.path.ensure_ext(self.filepath, SUFFIX)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what others are told of the map, beside the file browser."""
        character, column = active_character(context.scene), self.layout.column()
        if character is not None:
            for name in ("title", "author", "license", "description", "tags"):
                column.prop(character.character_map, name)

    def run(self, context: bpy.types.Context) -> None:
        """Write the file."""
        from ...core.retarget.maps.character_map_file import write_character_map

        if not self.filepath:
            raise InputError("no file is named to save the map to; give filepath")
        character = active_character(context.scene)
        character.character_map.title = _title(character)
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), SUFFIX))
        write_character_map(path, map_of(character.character_map))
        self.report({"INFO"}, f"Wrote {path}")


def _title(character: bpy.types.PropertyGroup) -> str:
    return character.character_map.title.strip() or str(character.armature.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_save_map,))
