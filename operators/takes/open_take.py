"""Open a take from disk or one that comes with Keymark; files that are dropped onto an editor."""

from pathlib import Path

import bpy
from bpy.types import Context, Event, Menu, OperatorProperties

from ...core.errors import InputError
from ...core.files.json_file import read_json_value
from ...core.files.paths import VIDEOS
from ..footage.load_footage import IMAGES
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, call, chosen_path, reported
from ..shell.fields import HIDDEN, SKIP_SAVE, Choice, File, Switch, Text


class KEYMARK_OT_open_take(BaseOperator, bpy.types.Operator):
    """Open a take: its footage behind its camera, its actor, what is followed, and its keyframes"""

    bl_label = "Open Take"
    requirements = (need.object_mode_possible, need.idle)

    filepath: File("The take's folder, or the take.json in it; in a shoot, also the clip alone")
    keyframes: Text("Keyframes", "Name of the keyframe file in the take's folder", default="keyframes.json")
    filter_glob: Text(default=";".join(("*take.json", *(f"*{ending}" for ending in VIDEOS))), options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        if self.filepath:
            return self.execute(context)
        return browse(self, context)

    def run(self, context: Context) -> None:
        """Read the take, and only then change the scene."""
        from ...core.shoot.discovery import take_path
        from .take_to_scene import open_in_scene, read_for_scene

        open_in_scene(self, context, read_for_scene(take_path(chosen_path(self)), self.keyframes))


def _draw_import(menu: Menu, context: Context) -> None:
    menu.layout.operator(KEYMARK_OT_open_take.bl_idname, text="Keymark Take (take.json)")


EXAMPLES = (
    (
        "AEROBIC",
        "Exercise in Colored Sleeves",
        "Four seconds of exercise in sleeves and leggings of five colors, picked already, with twelve "
        "keyframes posed by hand",
    ),
    (
        "GREETING",
        "Greeting in Plain Clothes",
        "Somebody comes in and waves, in clothes without markers: keypoints as a detector sees them, the "
        "body's contours, and ten keyframes posed by hand",
    ),
)


class KEYMARK_OT_open_example(BaseOperator, bpy.types.Operator):
    """Open a take that comes with Keymark, ready to reconstruct; nothing is written unless you copy it"""

    bl_label = "Open Example"
    requirements = (need.object_mode_possible, need.idle)

    example: Choice("Example", "Which take is opened", items=EXAMPLES, options=SKIP_SAVE)
    copy: Switch(
        "Copy to Folder",
        "Copy the take to a folder of yours first, and open that. Otherwise nothing is written, "
        "and the clip is read from Keymark's own folder, which goes when Keymark is removed",
        options=SKIP_SAVE,
    )
    directory: Text(
        "Folder",
        "The folder in which the copy gets a folder of its own",
        subtype="DIR_PATH",
        options=SKIP_SAVE,
    )
    filter_folder: Switch(default=True, options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        if not properties.is_property_set("example"):
            return cls.__doc__ or ""
        shown = next(text for name, _, text in EXAMPLES if name == properties.example)
        kept = properties.bl_rna.properties["copy"].description
        return f"{shown}.\n{kept}"

    def invoke(self, context: Context, event: Event) -> set[str]:
        if not self.properties.is_property_set("example"):
            context.window_manager.popup_menu(self._draw_menu, title=self.bl_label)
            return {"CANCELLED"}  # each entry is a step of its own
        if not self.copy or self.directory:
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    @staticmethod
    def _draw_menu(menu: Menu, context: Context) -> None:
        for copy, icon in ((False, "FILE_MOVIE"), (True, "FILE_FOLDER")):
            for name, title, _ in EXAMPLES:
                text = f"Copy {title} to Folder" if copy else title
                entry = menu.layout.operator("keymark.open_example", text=text, icon=icon, translate=False)
                entry.example, entry.copy = name, copy
            if not copy:
                menu.layout.separator()

    def draw(self, context: Context) -> None:
        self.layout.prop(self, "example", text="")

    def run(self, context: Context) -> None:
        """Copy the take if that is wanted, read it, and only then change the scene."""
        from ...core.take.examples import POSED_BY_HAND, copy_example, example_folder
        from .take_to_scene import open_in_scene, read_for_scene

        name = self.example.lower()
        if self.copy:
            if not self.directory:
                raise InputError("directory is empty; name the folder to copy the example to")
            opened = read_for_scene(copy_example(name, Path(bpy.path.abspath(self.directory))))
        else:
            opened = read_for_scene(example_folder(name), POSED_BY_HAND)
        open_in_scene(self, context, opened)


TAKE_FILE = "take.json"
"""Or NAME.take.json beside the clip NAME; opening a take reads no file of another name."""


class KEYMARK_OT_open_dropped(BaseOperator, bpy.types.Operator):
    """Open a take, import a keyframe library or load keypoints, depending on what the file holds"""

    bl_label = "Open Take, Library or Keypoints"
    bl_options = {"REGISTER", "INTERNAL"}
    requirements = (need.idle,)

    filepath: Text("File Path", subtype="FILE_PATH", options=SKIP_SAVE)

    def invoke(self, context: Context, event: Event) -> set[str]:
        with reported(self):
            return self.run(context, "INVOKE_DEFAULT")
        return {"CANCELLED"}

    def run(self, context: Context, how: str = "EXEC_DEFAULT") -> set[str]:
        """Call the operator for the file's content, and return its result."""
        from ...core.detect.keypoint_file import LARGEST_BYTES

        path = Path(bpy.path.abspath(self.filepath))
        value = read_json_value(path, LARGEST_BYTES)
        fields = value if isinstance(value, dict) else {}
        if "schema" in fields:
            operator = bpy.ops.keymark.import_library
        elif path.name == TAKE_FILE or path.name.endswith(f".{TAKE_FILE}"):
            operator = bpy.ops.keymark.open_take
        elif "clip" in fields:
            raise InputError(f"{path}: a take's file is called {TAKE_FILE}; give it that name to open it")
        elif bpy.ops.keymark.load_keypoints.poll():
            operator = bpy.ops.keymark.load_keypoints
        else:
            raise InputError(
                f"{path}: is neither a take's take.json nor a keyframe library; keypoints need the "
                "footage that they are of, so load that first"
            )
        return call(operator, how, filepath=str(path))


def _over_an_editor(context: Context) -> bool:
    return context.area is not None and context.area.type in {"VIEW_3D", "CLIP_EDITOR"}


class KEYMARK_FH_footage(bpy.types.FileHandler):
    """Dropped videos and images are loaded as footage."""

    bl_idname = "KEYMARK_FH_footage"
    bl_label = "Footage for Keymark"
    bl_import_operator = "keymark.load_footage"
    bl_file_extensions = ";".join(VIDEOS + IMAGES)

    @classmethod
    def poll_drop(cls, context: Context) -> bool:
        return _over_an_editor(context)


class KEYMARK_FH_take(bpy.types.FileHandler):
    """A dropped take.json is opened, a keyframe library imported, and keypoints are loaded."""

    bl_idname = "KEYMARK_FH_take"
    bl_label = "Take, Library or Keypoints for Keymark"
    bl_import_operator = "keymark.open_dropped"
    bl_file_extensions = ".json"

    @classmethod
    def poll_drop(cls, context: Context) -> bool:
        return _over_an_editor(context) or (context.area is not None and context.area.ui_type == "ASSETS")


MENUS = {"TOPBAR_MT_file_import": _draw_import}
