"""Finish a reconstructed motion: feet planted, as few keys as the animator's tolerance allows."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from .job_operator import JobOperator
from .requirements import actor, all_met, idle, motion
from .takes import active_take, take_called

if TYPE_CHECKING:
    from ..core.body.kinematics import Body
    from ..core.finish.rig import Rig
    from ..core.progress import Job

READ, PLANTED = 0.1, 0.4
"""Shares of the job at which the motion is read and the feet are planted."""
HELD = 0.2
"""Share of the tolerance that is left to an ankle that rests: few keys must not make it slide again."""
NOTICEABLE_M = 0.005
"""Distance [m] between a pose and its nearest posture that the animator is told of."""


@dataclass(frozen=True, eq=False)
class Finished:
    """What the job hands over to the scene."""

    take: str
    """The take's identifier."""
    body: "Body"
    rig: "Rig"
    frames: Any
    """(F,) scene frames."""
    motion: Any
    """For each bone its values on every frame, or few keys."""
    keys_before: int
    furthest_mm: float
    rests: int
    notes: tuple[str, ...]


class KEYMARK_OT_bake_motion(JobOperator, bpy.types.Operator):
    """Make the final Action, anew: your corrected motion with few keys, its resting feet standing still"""

    bl_idname = "keymark.bake_motion"
    bl_label = "Bake Final Action"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a motion."""
        return all_met(cls, context, actor, motion, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Finished]":
        """Read the motion and finish it."""
        from ..core.body.human import HUMAN
        from ..core.progress import stretch, within
        from .bridge.actor_lengths import read_body
        from .bridge.final_motion import motion_frames, read_values
        from .bridge.rig import read_rig

        take = active_take(scene)
        settings, armature_object, action = take.finish, take.armature, take.motion_action
        body = read_body(armature_object, HUMAN)
        rig = read_rig(armature_object, body)
        frames = motion_frames(armature_object, action, body)
        values = yield from within(
            "Reading the motion", read_values(armature_object, action, rig, frames), 0.0, READ
        )
        channels = sum(value.shape[1] for value in values)
        contacts: tuple[Any, ...] = ()
        notes: tuple[str, ...] = ()
        if settings.plant_feet:
            planting = self._plant(scene, take, body, rig, frames, values)
            values, contacts, notes = yield from stretch(planting, READ, PLANTED)
        finished: Any = values
        furthest_mm = 0.0
        if settings.keys == "TOLERANCE":
            reducing = self._reduce(take, body, rig, frames, values, contacts)
            reduced = yield from stretch(reducing, PLANTED, 1.0)
            finished, furthest_mm = reduced.splines, 1000.0 * reduced.furthest_m
        return Finished(
            take.identifier,
            body,
            rig,
            frames,
            finished,
            channels * len(frames),
            furthest_mm,
            len(contacts),
            notes,
        )

    def _plant(
        self, scene: bpy.types.Scene, take: Any, body: "Body", rig: "Rig", frames: Any, values: list[Any]
    ) -> "Job[tuple[list[Any], tuple[Any, ...], tuple[str, ...]]]":
        from ..core.finish.planted_feet import plant_feet
        from ..core.progress import within
        from .bridge.final_motion import furthest_from, shown_postures, with_planted_legs

        stage = "Planting the feet"
        shown = rig.show(values)
        posture = yield from within(stage, shown_postures(take.armature, rig, shown, body), 0.0, 0.8)
        time_s = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
        planting = plant_feet(body, posture, time_s, take.finish.stray_mm / 1000.0)
        planted = yield from within(stage, planting, 0.8, 1.0)
        notes: tuple[str, ...] = ()
        beyond_m = furthest_from(rig, shown, body, posture)
        if beyond_m > NOTICEABLE_M:
            notes = (
                f"The motion goes up to {1000.0 * beyond_m:.0f} mm beyond what the skeleton's legs can do; "
                "planting the feet uses the nearest posture",
            )
        if not planted.contacts:
            return values, (), (*notes, "No foot rests long enough to be planted; raise Stray if one sways")
        return with_planted_legs(take.armature, rig, values, planted.posture), planted.contacts, notes

    def _reduce(
        self, take: Any, body: "Body", rig: "Rig", frames: Any, values: list[Any], contacts: tuple[Any, ...]
    ) -> "Job[Any]":
        from ..core.finish.key_reduction import reduce_keys
        from ..core.progress import within
        from .bridge.final_motion import posed_positions, tolerances

        settings = take.finish
        exact = posed_positions(take.armature, take.keyframe_action, body.skeleton, frames)
        tolerance_m = tolerances(rig, len(frames), settings.tolerance_mm / 1000.0, contacts, HELD)
        whole_pose = settings.shared == "WHOLE_POSE"
        reducing = reduce_keys(rig, frames, values, tolerance_m, exact, whole_pose)
        return (yield from within("Finding the keys", reducing, 0.0, 1.0))

    def finish(self, scene: bpy.types.Scene, result: Finished) -> None:
        """Write the final Action and let it animate the actor."""
        from .bridge.actions import assign_action
        from .bridge.final_motion import write_final

        take = take_called(scene, result.take)
        settings, armature_object = take.finish, take.armature
        if settings.action is None:
            settings.action = bpy.data.actions.new(f"{armature_object.name} Final")
        settings.action.use_fake_user = True
        settings.keys_before = result.keys_before
        settings.keys_after = write_final(
            armature_object,
            take.motion_action,
            settings.action,
            result.body,
            result.rig,
            result.frames,
            result.motion,
        )
        settings.furthest_mm, settings.rests = result.furthest_mm, result.rests
        assign_action(armature_object, settings.action)
        scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
        for note in result.notes:
            self.report({"WARNING"}, note)
        self.report(
            {"INFO"},
            f"Baked {settings.keys_after} keys of {settings.keys_before} into '{settings.action.name}', "
            f"at most {settings.furthest_mm:.1f} mm off",
        )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_bake_motion,))
