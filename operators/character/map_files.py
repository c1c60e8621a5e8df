"""Load a character's map from a file."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator, browse, chosen_file, reported
from ..shell.fields import HIDDEN, SKIP_SAVE, Switch, Text
from ..shell.requirements import idle
from .characters import active_character
from .map_properties import map_of, show_map
from .recognition import map_folders, show_doubts
from .requirements import armature, recognized


class KEYMARK_OT_load_map(BaseOperator, bpy.types.Operator):
    """Load which bones play which role from a file, instead of what was recognized"""

    bl_label = "Load Map"
    requirements = (armature, idle)

    filepath: Text("File Path", "A character map", subtype="FILE_PATH", options=SKIP_SAVE)
    title: Text(
        "Title",
        "Title of a map in your library folder, instead of a file",
        options=SKIP_SAVE,
    )
    filter_glob: Text(default="*.json", options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        if properties.title:
            return "Use this map from your library folder, which names this armature's bones"
        return "Load which bones play which role from a file, instead of what was recognized"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.filepath or self.title:
            return self.execute(context)
        return browse(self, context, str(map_folders()[0]))

    def run(self, context: bpy.types.Context) -> None:
        from ...core.retarget.maps.map_registry import check_map, find_map
        from ..bridge.character.read_character import read_character

        character = active_character(context.scene)
        named = (
            self.title if self.title and not self.filepath else chosen_file(self, "a character map, .json")
        )
        found = find_map(named, map_folders())
        character_map = found.valid
        check_map(character_map, read_character(character.armature), str(found.path))
        show_map(character.character_map, character_map)
        show_doubts(character)
        character.problem = character.suggested = ""
        self.report({"INFO"}, f"Loaded '{character_map.title}'")


# --- Save a character's map as a file, to use it elsewhere and to share it


SUFFIX = ".json"


class KEYMARK_OT_save_map(BaseOperator, bpy.types.Operator):
    """Save which bones play which role as a file; in the folder that is offered it is found again"""

    bl_label = "Save Map"
    bl_options = {"REGISTER"}
    requirements = (recognized, idle)

    filepath: Text("File", "File to write", subtype="FILE_PATH")
    check_existing: Switch(default=True, options=HIDDEN)
    filter_glob: Text(default=f"*{SUFFIX}", options=HIDDEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        from ...core.retarget.maps.map_registry import map_path

        with reported(self):
            title = _title(active_character(context.scene))
            self.filepath = str(map_path(map_folders()[0], title))
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def check(self, context: bpy.types.Context) -> bool:
        path = bpy.path.ensure_ext(self.filepath, SUFFIX)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def draw(self, context: bpy.types.Context) -> None:
        character, column = active_character(context.scene), self.layout.column()
        if character is not None:
            for name in ("title", "author", "license", "description", "tags"):
                column.prop(character.character_map, name)

    def run(self, context: bpy.types.Context) -> None:
        from ...core.retarget.maps.character_map import write_character_map

        if not self.filepath:
            raise InputError("no file is named to save the map to; give filepath")
        character = active_character(context.scene)
        character.character_map.title = _title(character)
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), SUFFIX))
        write_character_map(path, map_of(character.character_map))
        self.report({"INFO"}, f"Wrote {path}")


def _title(character: bpy.types.PropertyGroup) -> str:
    return character.character_map.title.strip() or str(character.armature.name)
