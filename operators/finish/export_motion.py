"""Write a take's motion for another program."""

from pathlib import Path

import bpy

from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..bridge.export_formats import FORMATS
from ..bridge.motion_export import export_motion
from ..shell.base_operator import BaseOperator
from ..shell.messages import warn_if_outdated
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take


class KEYMARK_OT_export_motion(BaseOperator, bpy.types.Operator):
    """Write the actor's armature with its motion, the final Action if there is one, for another program"""

    bl_idname = "keymark.export_motion"
    bl_label = "Export Motion"
    bl_options = {"REGISTER"}

    format: bpy.props.EnumProperty(
        name="Format",
        description="Format of the file",
        items=[(kind, listed.name, listed.description) for kind, listed in FORMATS.items()],
    )
    filepath: bpy.props.StringProperty(name="File", description="File to write", subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(
        default=";".join(f"*{listed.suffix}" for listed in FORMATS.values()), options={"HIDDEN"}
    )

    requirements = (actor, motion, idle)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The chosen format's own tooltip."""
        return FORMATS[properties.format].description

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        folder = "//" if bpy.data.filepath else ""
        name = bpy.path.clean_name(active_take(context.scene).name)
        self.filepath = bpy.path.abspath(folder + name + FORMATS[self.format].suffix)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: bpy.types.Context) -> bool:
        """Give the file's name the suffix of the format."""
        path = bpy.path.ensure_ext(self.filepath, FORMATS[self.format].suffix)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def run(self, context: bpy.types.Context) -> None:
        """Write the file."""
        from ..bridge.actor_lengths import read_body
        from ..bridge.final_motion import motion_frames

        if not self.filepath:
            raise InputError("no file is named to export to; give filepath")
        chosen = FORMATS[self.format]
        missing = chosen.missing()
        if missing:
            raise InputError(f"{chosen.name} cannot be written: {missing}")
        take = active_take(context.scene)
        action = take.finish.action or take.motion_action
        frames = motion_frames(take.armature, action, read_body(take.armature, HUMAN))
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), chosen.suffix))
        span = int(frames[0]), int(frames[-1])
        export_motion(context.scene, take.armature, action, span, chosen, path)
        warn_if_outdated(self, take)
        self.report({"INFO"}, f"Wrote {path}")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_export_motion,))
