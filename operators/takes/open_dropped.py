"""A .json that was dropped: a take is opened, a keyframe library is imported."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ...core.files.json_file import read_json
from ..shell.error_reports import reported
from ..shell.requirements import all_met, idle

TAKE_FILE = "take.json"
"""Or NAME.take.json beside the clip NAME; a file of another name would not be the one that is read."""


class KEYMARK_OT_open_dropped(bpy.types.Operator):
    """Open a take, or import a keyframe library, as the file turns out to be"""

    bl_idname = "keymark.open_dropped"
    bl_label = "Open Take or Library"
    bl_options = {"REGISTER", "INTERNAL"}

    filepath: bpy.props.StringProperty(name="File Path", subtype="FILE_PATH", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Not while a job runs."""
        return all_met(cls, context, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Hand it on, so that it may ask."""
        return self._hand_on("INVOKE_DEFAULT")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Hand it on."""
        return self._hand_on("EXEC_DEFAULT")

    def _hand_on(self, how: str) -> set[str]:
        with reported(self):
            from ...core.library.library_file import LARGEST_BYTES

            path = Path(bpy.path.abspath(self.filepath))
            value = read_json(path, LARGEST_BYTES)
            if "schema" in value:
                opened = bpy.ops.keymark.import_library
            elif path.name == TAKE_FILE or path.name.endswith(f".{TAKE_FILE}"):
                opened = bpy.ops.keymark.open_take
            elif "clip" in value:
                raise InputError(f"{path}: a take's file is called {TAKE_FILE}; give it that name to open it")
            else:
                raise InputError(f"{path}: is neither a take's take.json nor a keyframe library")
            try:
                return set(opened(how, filepath=str(path)))
            except RuntimeError as error:  # what it reported already, as a script would get it
                raise InputError(str(error).removeprefix("Error: ").strip()) from error
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_open_dropped,))
