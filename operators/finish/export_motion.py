"""Write a take's motion for another program."""

from pathlib import Path

import bpy

from ...core.body.human import HUMAN
from ...core.errors import InputError
from ..bridge.export_formats import FORMATS
from ..shell.error_reports import reported
from ..shell.messages import say, warn_if_outdated
from ..shell.requirements import actor, all_met, idle, motion
from ..shell.takes import active_take


class KEYMARK_OT_export_motion(bpy.types.Operator):
    """Write the actor's armature with its motion, the final Action if there is one, for another program"""

    bl_idname = "keymark.export_motion"
    bl_label = "Export Motion"
    bl_options = {"REGISTER"}

    format: bpy.props.EnumProperty(
        name="Format",
        description="The kind of file",
        items=[(kind, chosen.name, chosen.words) for kind, chosen in FORMATS.items()],
    )
    filepath: bpy.props.StringProperty(name="File", description="Where to write", subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.bvh;*.fbx;*.glb;*.usdc", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a motion."""
        return all_met(cls, context, actor, motion, idle)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The chosen format's own words."""
        return FORMATS[properties.format].words

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        folder = "//" if bpy.data.filepath else ""
        name = bpy.path.clean_name(active_take(context.scene).name)
        self.filepath = bpy.path.abspath(folder + name + FORMATS[self.format].suffix)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: bpy.types.Context) -> bool:
        """Let the file's name end as the format wants it."""
        path = bpy.path.ensure_ext(self.filepath, FORMATS[self.format].suffix)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write it."""
        with reported(self):
            from ..bridge.actor_lengths import read_body
            from ..bridge.exports import export_motion
            from ..bridge.final_motion import motion_frames

            if not self.filepath:
                raise InputError("no file is named to export to; give filepath")
            missing = FORMATS[self.format].missing()
            if missing:
                raise InputError(f"{FORMATS[self.format].name} cannot be written: {missing}")
            take = active_take(context.scene)
            action = take.finish.action or take.motion_action
            frames = motion_frames(take.armature, action, read_body(take.armature, HUMAN))
            path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), FORMATS[self.format].suffix))
            span = int(frames[0]), int(frames[-1])
            export_motion(context.scene, take.armature, action, span, self.format, path)
            warn_if_outdated(self, take)
            say(self, "INFO", "Wrote {path}", path=path)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_export_motion,))
