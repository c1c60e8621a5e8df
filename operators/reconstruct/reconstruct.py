"""Reconstruct the motion between the keyframes from the footage."""

from typing import TYPE_CHECKING, Any

import bpy
from bpy.types import Context, Scene

from ...core.errors import InputError
from ...core.progress import Job, Progress, stretch
from ..bridge.actions import assign_action
from ..keyframes.found_properties import known_matches
from ..keyframes.scene_session import READ, SceneSession, go_on, read_session
from ..shell import need
from ..shell.base_operator import BaseOperator, capitalized, warn
from ..shell.fields import Choice
from ..shell.job_operator import JobOperator
from ..shell.keyed_frames import straighten_unposed
from ..shell.takes import active_take

if TYPE_CHECKING:
    from ...core.review.review import Review


SOLVED = 0.97
"""Share of the job at which the motion is found."""


def reconstruct_take(operator: "PreviewedJob", scene: Scene) -> "Job[tuple[SceneSession, Review]]":
    """Go on with the active take until its motion is reconstructed and judged; the scene stays as it is."""
    from ...core.estimate.reconstruct import check_reconstructible
    from .live_preview import LivePreview

    settings = active_take(scene)
    watched, armature, method = settings.live_preview, settings.armature, settings.method
    reading = read_session(scene, settings, known_matches(settings), method=method)
    made = yield from stretch(reading, 0.0, READ)
    take = made.session.inputs.take
    if take.reference is None or method != "map":
        count = len(take.keyframes)
        if count < 2:
            raise InputError(
                f"{count} of the 2 keyframes that are needed lie in the footage; press Pose All or pose the "
                f"actor{''.join(f'. {capitalized(note)}' for note in made.notes)}"
            )
    check_reconstructible(take, method)

    def keep(stage: str, now: SceneSession) -> None:
        if stage == "read" and watched:
            operator.preview = LivePreview(scene, armature, now.frames)

    made = yield from stretch(go_on(made, "reconstruct", keep), 0.0, SOLVED)
    return made, (yield from stretch(judge(made), SOLVED, 1.0))


def judge(made: SceneSession) -> "Job[Review]":
    """The review of a session's motion."""
    from ...core.estimate.reconstruct import Reconstruction
    from ...core.review.review import review
    from ...core.session.session import Posed

    return review(made.session[Posed].seen.take, made.session[Reconstruction], made.frames)


def keep_motion(operator: JobOperator, scene: Scene, made: SceneSession, judged: "Review") -> str:
    """Write the motion; the keyframes stay in their own Action. Returns a line."""
    from ...core.estimate.reconstruct import Reconstruction
    from ...core.take.presence import unseen_line
    from .live_preview import write_result

    result = made.session[Reconstruction]
    take = write_result(scene, made, judged)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    take.notes.clear()
    for note in (*made.notes, *result.notes):
        take.notes.add().text = warn(operator, note)
    take.review.unseen = capitalized(unseen_line(len(result.motion.empty), result.motion.unseen))
    return f"Reconstructed {len(made.frames)} frames from {len(result.motion.keyframe_indices)} keyframes"


class PreviewedJob(JobOperator):
    """Mixin of a job that shows the motion on the actor while later frames are computed."""

    preview: Any = None
    """The running `LivePreview`; not named as type, since Blender evaluates annotations of its classes."""

    def watch(self, progress: Progress) -> None:
        if self.preview is not None and progress.preview is not None:
            self.preview.show(progress.preview)

    def unwatch(self) -> None:
        if self.preview is not None:
            self.preview.end()
            self.preview = None


class KEYMARK_OT_reconstruct(PreviewedJob, bpy.types.Operator):
    """Reconstruct every frame from the footage and the keyframes; the motion becomes an Action of its own"""

    bl_label = "Reconstruct"
    requirements = need.RECONSTRUCTION

    def start(self, scene: Scene) -> "Job[tuple[SceneSession, Review]]":
        return (yield from reconstruct_take(self, scene))

    def finish(self, scene: Scene, result: "tuple[SceneSession, Review]") -> None:
        self.report({"INFO"}, keep_motion(self, scene, *result))


class KEYMARK_OT_show_action(BaseOperator, bpy.types.Operator):
    """Animate the actor by its keyframes, the reconstructed motion or the final Action"""

    bl_label = "Show on Actor"
    requirements = (need.actor, need.idle)

    which: Choice(
        "Show",
        "Action of the take to show",
        items=[
            ("KEYFRAMES", "Keyframes", "Animate the actor by its keyframes"),
            ("MOTION", "Motion", "Animate the actor by the reconstructed motion"),
            ("FINAL", "Final", "Animate the actor by the final Action"),
        ],
    )

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        action, missing = {
            "KEYFRAMES": (take.keyframe_action, "there are no keyframes yet; pose the actor and store one"),
            "MOTION": (take.motion_action, "there is no motion yet; reconstruct it"),
            "FINAL": (take.finish.action, "there is no final Action yet; bake it"),
        }[self.which]
        if action is None:
            raise InputError(missing)
        if self.which == "KEYFRAMES":
            straighten_unposed(take)
        assign_action(take.armature, action)
