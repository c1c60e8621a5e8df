"""Open a take that comes with Keymark, ready to reconstruct."""

from pathlib import Path

import bpy

from ...core.errors import InputError
from ..shell.base_operator import BaseOperator
from ..shell.requirements import idle, object_mode_possible

AEROBIC, GREETING = "AEROBIC", "GREETING"
EXAMPLES = (
    (
        AEROBIC,
        "Exercise in Colored Sleeves",
        "Four seconds of exercise in sleeves and leggings of five colors, picked already, with twelve "
        "keyframes posed by hand",
    ),
    (
        GREETING,
        "Greeting in Plain Clothes",
        "Somebody comes in and waves, in clothes without markers: keypoints as a detector sees them, the "
        "body's contours, and ten keyframes posed by hand",
    ),
)


class KEYMARK_OT_open_example(BaseOperator, bpy.types.Operator):
    """Open a take that comes with Keymark, ready to reconstruct; nothing is written unless you copy it"""

    bl_idname = "keymark.open_example"
    bl_label = "Open Example"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (object_mode_possible, idle)

    example: bpy.props.EnumProperty(
        name="Example", description="Which take is opened", items=EXAMPLES, options={"SKIP_SAVE"}
    )
    copy: bpy.props.BoolProperty(
        name="Copy to Folder",
        description="Copy the take to a folder of yours first, and open that. Otherwise nothing is written, "
        "and the clip is read from Keymark's own folder, which goes when Keymark is removed",
        default=False,
        options={"SKIP_SAVE"},
    )
    directory: bpy.props.StringProperty(
        name="Folder",
        description="The folder in which the copy gets a folder of its own",
        subtype="DIR_PATH",
        options={"SKIP_SAVE"},
    )
    filter_folder: bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """What the chosen example shows, and where its clip lies."""
        if not properties.is_property_set("example"):
            return cls.__doc__ or ""
        shown = next(text for name, _, text in EXAMPLES if name == properties.example)
        kept = cls.bl_rna.properties["copy"].description
        return f"{shown}.\n{kept}"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask which example, and for the folder of a copy."""
        if not self.properties.is_property_set("example"):
            context.window_manager.popup_menu(_draw_examples, title=self.bl_label)
            return {"CANCELLED"}  # each entry is a step of its own
        if not self.copy or self.directory:
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw which example, beside the folder's picker and in Adjust Last Operation."""
        self.layout.prop(self, "example", text="")

    def run(self, context: bpy.types.Context) -> None:
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


def _draw_examples(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Draw each example, to be opened as it is, and once more to be copied first."""
    layout = menu.layout
    for copy, icon in ((False, "FILE_MOVIE"), (True, "FILE_FOLDER")):
        for name, title, _ in EXAMPLES:
            text = title
            entry = layout.operator(
                KEYMARK_OT_open_example.bl_idname,
                text=f"Copy {text} to Folder" if copy else text,
                icon=icon,
                translate=False,
            )
            entry.example, entry.copy = name, copy
        if not copy:
            layout.separator()


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_open_example,))
