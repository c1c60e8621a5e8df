"""Open a dropped .json: a take, a keyframe library, or keypoints of the active take's clip."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ...core.files.json_file import read_json_value
from ..shell.base_operator import BaseOperator
from ..shell.error_reports import reported
from ..shell.requirements import footage, idle

TAKE_FILE = "take.json"
"""Or NAME.take.json beside the clip NAME; opening a take reads no file of another name."""


class KEYMARK_OT_open_dropped(BaseOperator, bpy.types.Operator):
    """Open a take, import a keyframe library or load keypoints, depending on what the file holds"""

    bl_idname = "keymark.open_dropped"
    bl_label = "Open Take, Library or Keypoints"
    bl_options = {"REGISTER", "INTERNAL"}
    requirements = (idle,)

    filepath: bpy.props.StringProperty(name="File Path", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Invoke the file's operator, which may show a dialog."""
        with reported(self):
            return self._delegate("INVOKE_DEFAULT")
        return {"CANCELLED"}

    def run(self, context: bpy.types.Context) -> set[str]:
        """Run the file's operator."""
        return self._delegate("EXEC_DEFAULT")

    def _delegate(self, execution_context: str) -> set[str]:
        """Call the operator for the file's content, and return its result.

        Raises:
            InputError: The file is none of these, or the operator failed.
        """
        from ...core.footage.keypoints.keypoint_file import LARGEST_BYTES

        path = Path(bpy.path.abspath(self.filepath))
        value = read_json_value(path, LARGEST_BYTES)
        fields = value if isinstance(value, dict) else {}
        if "schema" in fields:
            operator = bpy.ops.keymark.import_library
        elif path.name == TAKE_FILE or path.name.endswith(f".{TAKE_FILE}"):
            operator = bpy.ops.keymark.open_take
        elif "clip" in fields:
            raise InputError(f"{path}: a take's file is called {TAKE_FILE}; give it that name to open it")
        elif footage(bpy.context) is None:
            operator = bpy.ops.keymark.load_keypoints
        else:
            raise InputError(
                f"{path}: is neither a take's take.json nor a keyframe library; keypoints need the "
                "footage that they are of, so load that first"
            )
        try:
            return set(operator(execution_context, filepath=str(path)))
        except RuntimeError as error:  # the operator's own error report
            raise InputError(str(error).removeprefix("Error: ").strip()) from error


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_open_dropped,))
