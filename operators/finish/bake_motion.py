"""Finish a reconstructed motion: feet planted, as few keys as the animator's tolerance allows."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..bridge.actions import assign_action
from ..shell.job_operator import JobOperator
from ..shell.messages import warn
from ..shell.notices import give_notices
from ..shell.outdated import finished_again
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take, actor_of, take_by_identifier

if TYPE_CHECKING:
    from ...core.progress import Job
    from ..bridge.finish_motion import Finished


@dataclass(frozen=True, eq=False)
class FinishedTake:
    """A finished motion of a take."""

    take: str
    """The take's identifier."""
    finished: "Finished"


class KEYMARK_OT_bake_motion(JobOperator, bpy.types.Operator):
    """Make the final Action, anew: your corrected motion with few keys, its resting feet standing still"""

    bl_idname = "keymark.bake_motion"
    bl_label = "Bake Final Action"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, motion, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[FinishedTake]":
        """Read the motion and finish it, with the options at the start of the job."""
        from ..bridge.finish_motion import FinishOptions, finish_motion

        take = active_take(scene)
        settings, identifier = take.finish, take.identifier
        options = FinishOptions(
            tolerance_m=settings.tolerance_mm / 1000.0 if settings.keys == "TOLERANCE" else None,
            whole_pose=settings.shared == "WHOLE_POSE",
            stray_m=settings.stray_mm / 1000.0 if settings.plant_feet else None,
        )
        frame_s = scene.render.fps_base / scene.render.fps
        job = finish_motion(take.armature, take.motion_action, take.keyframe_action, options, frame_s)
        del take, settings  # Blender may move them while the job runs
        return FinishedTake(identifier, (yield from job))

    def finish(self, scene: bpy.types.Scene, result: FinishedTake) -> None:
        """Write the final Action and assign it to the actor."""
        take, finished = take_by_identifier(scene, result.take), result.finished
        settings, armature_object = take.finish, actor_of(take)
        if take.motion_action is None:
            raise InputError("the motion has been deleted meanwhile; nothing was changed")
        if settings.action is None:
            settings.action = bpy.data.actions.new(f"{armature_object.name} Final")
        settings.action.use_fake_user = True
        settings.keys_after = finished.write(armature_object, take.motion_action, settings.action)
        settings.keys_before, settings.outdated = finished.keys_before, False
        settings.furthest_mm, settings.rests = 1000.0 * finished.furthest_m, len(finished.contacts)
        finished_again(take)
        assign_action(armature_object, settings.action)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        give_notices(take, "finish", "bake", [warn(self, note) for note in finished.notes])
        self.report(
            {"INFO"},
            f"Baked {settings.keys_after} keys of {settings.keys_before} into '{settings.action.name}', "
            f"at most {settings.furthest_mm:.1f} mm off",
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_bake_motion,))
