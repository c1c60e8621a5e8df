"""Write a take's motion for another program."""

from pathlib import Path

import bpy

from .failures import reported
from .requirements import actor, all_met, idle, motion
from .takes import active_take

FORMATS = (
    ("BVH", "BVH", "Skeleton and motion as text, which most animation programs read"),
    ("FBX", "FBX", "For game engines and other animation programs"),
    ("GLTF", "glTF", "One binary file (.glb) for engines and the web"),
    ("USD", "USD", "For film pipelines: a skeleton with its animation"),
)


class KEYMARK_OT_export_motion(bpy.types.Operator):
    """Write the actor's armature with its motion, the final Action if there is one, for another program"""

    bl_idname = "keymark.export_motion"
    bl_label = "Export Motion"
    bl_options = {"REGISTER"}

    format: bpy.props.EnumProperty(name="Format", description="The kind of file", items=FORMATS)
    filepath: bpy.props.StringProperty(name="File", description="Where to write", subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.bvh;*.fbx;*.glb;*.usdc", options={"HIDDEN"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a motion."""
        return all_met(cls, context, actor, motion, idle)

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """The chosen format's own words."""
        return next(words for name, _, words in FORMATS if name == properties.format)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the file."""
        with reported(self):
            from .bridge.exports import suggested_path

            self.filepath = suggested_path(active_take(context.scene).name, self.format)
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def check(self, context: bpy.types.Context) -> bool:
        """Let the file's name end as the format wants it."""
        from .bridge.exports import FORMATS as KINDS

        path = bpy.path.ensure_ext(self.filepath, KINDS[self.format].suffix)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write it."""
        with reported(self):
            from ..core.body.human import HUMAN
            from ..core.errors import InputError
            from .bridge.actor_lengths import read_body
            from .bridge.exports import FORMATS as KINDS
            from .bridge.exports import export_motion
            from .bridge.final_motion import motion_frames

            if not self.filepath:
                raise InputError("no file is named to export to; give filepath")
            take = active_take(context.scene)
            action = take.finish.action or take.motion_action
            frames = motion_frames(take.armature, action, read_body(take.armature, HUMAN))
            path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), KINDS[self.format].suffix))
            span = int(frames[0]), int(frames[-1])
            export_motion(context.scene, take.armature, action, span, self.format, path)
            self.report({"INFO"}, f"Wrote {path}")
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_export_motion,))
