"""Add a motion to the library that is made in this file."""

from typing import TYPE_CHECKING

import bpy

from ....core.arrays import Array
from ....core.body.human import HUMAN
from ....core.errors import InputError
from ...shell.error_reports import reported
from ...shell.messages import say
from ...shell.redraw import refresh_asset_browsers
from ...shell.requirements import all_met, idle, scene_library
from ...shell.takes import find_take
from .scene_libraries import library_here

if TYPE_CHECKING:
    pass


class KEYMARK_OT_add_motion(bpy.types.Operator):
    """Add a motion to the library: an order of its postures, with the times at which they come"""

    bl_idname = "keymark.add_motion"
    bl_label = "Add Motion"
    bl_options = {"REGISTER", "UNDO"}

    source: bpy.props.EnumProperty(
        name="From",
        description="Which postures it leads through",
        items=[
            ("POSTURES", "The Library's Postures", "All postures in their order, evenly in time"),
            ("KEYFRAMES", "The Take's Keyframes", "Each keyframe becomes a posture and comes at its time"),
        ],
    )
    motion: bpy.props.StringProperty(
        name="Name", description="What the motion is called, such as Brisk Walking", default="Motion"
    )
    duration_s: bpy.props.FloatProperty(
        name="Duration (s)",
        description="How long the whole motion takes, where the take's keyframes do not tell",
        default=1.0,
        min=0.01,
        max=600.0,
    )
    cyclic: bpy.props.BoolProperty(
        name="Cyclic",
        description="After the last posture the first comes again, as in walking; the last keyframe is "
        "then that very posture",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a library."""
        return all_met(cls, context, scene_library, idle)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        return context.window_manager.invoke_props_dialog(self, confirm_text="Add")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what counts for the chosen source."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "source")
        column.prop(self, "motion")
        if self.source == "POSTURES":
            column.prop(self, "duration_s")
        column.prop(self, "cyclic")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it."""
        with reported(self):
            from .scene_postures import keep_motion

            group = library_here(context.scene)
            if self.source == "KEYFRAMES":
                names, time_s = self._keyframes(context, group)
            else:
                import numpy as np

                names = [entry.name for entry in group.postures if entry.action is not None]
                if len(names) < 2:
                    raise InputError("a motion leads through two postures or more; add postures first")
                steps = np.arange(len(names) + 1) if self.cyclic else np.arange(len(names))
                time_s = self.duration_s * steps / steps[-1]
            motion = keep_motion(group, self.motion, names, time_s, cyclic=self.cyclic)
            refresh_asset_browsers(context)
            say(
                self,
                "INFO",
                "'{name}' leads through {count} postures in {duration:.2f} s",
                name=motion.name,
                count=len(motion.steps),
                duration=motion.duration_s,
            )
            return {"FINISHED"}
        return {"CANCELLED"}

    def _keyframes(
        self, context: bpy.types.Context, group: bpy.types.PropertyGroup
    ) -> "tuple[list[str], Array]":
        """Postures made of the take's keyframes, and their times [s]."""
        import numpy as np

        from ....core.body.posture import Posture
        from ...bridge.actor_lengths import read_body
        from ...bridge.keyframes import keyed_frames, read_keyframes
        from .scene_postures import keep_postures

        scene, take = context.scene, find_take(context.scene)
        if take is None or take.armature is None or take.keyframe_action is None:
            raise InputError("the take has no keyframes; pose the actor and store some first")
        body = read_body(take.armature, HUMAN)
        frames = np.array(keyed_frames(take.armature, take.keyframe_action, HUMAN))
        if len(frames) < (3 if self.cyclic else 2):
            raise InputError(f"the take has {len(frames)} keyframes; a motion needs two, a cyclic one three")
        posed = read_keyframes(scene, take.armature, take.keyframe_action, body, frames).keyframes
        time_s = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
        kept = posed[:-1] if self.cyclic else posed
        digits = len(str(len(kept)))
        names = [f"{self.motion.strip()} {number:0{digits}}" for number in range(1, len(kept) + 1)]
        postures = Posture.stack([keyframe.posture for keyframe in kept])
        return keep_postures(group, body, postures, names, on_floor=True), time_s


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_add_motion,))
