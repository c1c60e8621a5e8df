"""Reconstruct the motion between the keyframes from the footage."""

from typing import TYPE_CHECKING, Any

import bpy

from ...core.errors import InputError
from ...core.progress import stretch
from ..bridge.actions import assign_action
from ..bridge.scene_frames import scene_frames
from ..follow.evidence import anything_to_follow, scene_evidence
from ..keyframes.found_keyframes import known_matches
from ..shell.base_operator import BaseOperator, capitalized, warn
from ..shell.job_operator import JobOperator
from ..shell.keyed_frames import straighten_unposed
from ..shell.requirements import actor, all_colors, footage, idle, two_keyframes
from ..shell.results import last_reconstruction, reading_of
from ..shell.takes import active_take, footage_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...core.progress import Job, Progress
    from .live_preview import LivePreview, ReconstructionResult


TIMES, READ, SOLVED = 0.05, 0.4, 0.97
"""Shares of the job at which the clip's times are read, its pictures, and the motion is found."""


def reconstruct_take(
    scene: bpy.types.Scene, show: "Callable[[LivePreview], None]"
) -> "Job[ReconstructionResult]":
    """Read the active take and reconstruct it, starting from the last reading and reconstruction.

    `show` gets the preview, where the take wants one; the scene stays as it is.
    """
    from ...core.estimate.reconstruct import Reconstruction, check_reconstructible
    from ...core.review.review import review
    from ...core.session.session import Inputs, Session
    from ...core.session.stages import reach
    from ...core.take.read_footage import read_footage
    from ..bridge.take_from_scene import read_scene_take
    from .live_preview import LivePreview, ReconstructionResult

    settings = active_take(scene)
    identifier, method, armature = settings.identifier, settings.method, settings.armature
    watched, kept, earlier = settings.live_preview, reading_of(settings), last_reconstruction(settings)
    evidence, known = scene_evidence(settings), known_matches(settings)
    source, keys = footage_of(scene, settings), settings.keyframe_action
    reading_scene = read_scene_take(source, armature, keys, evidence, known, kept)
    take, notes = yield from stretch(reading_scene, 0.0, TIMES)
    if take.reference is None or method != "map":
        _check_enough(len(take.keyframes), notes)
    check_reconstructible(take, method)
    reading = yield from stretch(read_footage(take, kept), TIMES, READ)
    frames = scene_frames(reading.tracks.time_s, take.frame_start, take.fps)
    if watched:
        show(LivePreview(scene, armature, frames))
    inputs = Inputs(take, method, floor_m=settings.matching.known_floor_m, earlier=earlier)
    way = reach(Session(inputs, {"read": reading}), "reconstruct")
    result = (yield from stretch(way, READ, SOLVED))[Reconstruction]
    judged = yield from stretch(review(take, result, frames), SOLVED, 1.0)
    return ReconstructionResult(identifier, frames, result, judged, (*notes, *result.notes))


def keep_reconstruction(
    operator: bpy.types.Operator, scene: bpy.types.Scene, result: "ReconstructionResult"
) -> str:
    """Write the motion; the keyframes stay in their own Action. Returns a sentence on it."""
    from ...core.take.presence import unseen_line

    take = result.write(scene)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    take.notes.clear()
    for note in result.notes:
        take.notes.add().text = warn(operator, note)
    motion = result.reconstruction.motion
    take.review.unseen = capitalized(unseen_line(len(motion.empty), motion.unseen))
    count = len(motion.keyframe_indices)
    return f"Reconstructed {len(result.frames)} frames from {count} keyframes"


class KEYMARK_OT_reconstruct(JobOperator, bpy.types.Operator):
    """Reconstruct every frame from the footage and the keyframes; the motion becomes an Action of its own"""

    bl_idname = "keymark.reconstruct"
    bl_label = "Reconstruct"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, actor, anything_to_follow, all_colors, two_keyframes, idle)
    preview: Any = None
    """The running `LivePreview`; not named as type, since Blender evaluates annotations of its classes."""

    def start(self, scene: bpy.types.Scene) -> "Job[ReconstructionResult]":
        def keep(preview: "LivePreview") -> None:
            self.preview = preview

        return (yield from reconstruct_take(scene, keep))

    def watch(self, progress: "Progress") -> None:
        if self.preview is not None and progress.preview is not None:
            self.preview.show(progress.preview)

    def unwatch(self) -> None:
        if self.preview is not None:
            self.preview.end()
            self.preview = None

    def finish(self, scene: bpy.types.Scene, result: "ReconstructionResult") -> None:
        said = keep_reconstruction(self, scene, result)
        self.report({"INFO"}, said)


def _check_enough(count: int, notes: tuple[str, ...]) -> None:
    """Refuse a take with fewer than two keyframes, with the notes on those that do not count."""
    if count < 2:
        raise InputError(
            f"{count} of the 2 keyframes that are needed lie in the footage; press Pose All or pose the "
            f"actor{''.join(f'. {capitalized(note)}' for note in notes)}"
        )


MISSING = {
    "KEYFRAMES": "There are no keyframes yet; pose the actor and store one",
    "MOTION": "There is no motion yet; reconstruct it",
    "FINAL": "There is no final Action yet; bake it",
}


class KEYMARK_OT_show_action(BaseOperator, bpy.types.Operator):
    """Animate the actor by its keyframes, the reconstructed motion or the final Action"""

    bl_idname = "keymark.show_action"
    bl_label = "Show on Actor"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, idle)

    which: bpy.props.EnumProperty(
        name="Show",
        description="Action of the take to show",
        items=[
            ("KEYFRAMES", "Keyframes", "Animate the actor by its keyframes"),
            ("MOTION", "Motion", "Animate the actor by the reconstructed motion"),
            ("FINAL", "Final", "Animate the actor by the final Action"),
        ],
    )

    def run(self, context: bpy.types.Context) -> set[str] | None:
        settings = active_take(context.scene)
        action = {
            "KEYFRAMES": settings.keyframe_action,
            "MOTION": settings.motion_action,
            "FINAL": settings.finish.action,
        }[self.which]
        if action is None:
            self.report({"ERROR"}, MISSING[self.which])
            return {"CANCELLED"}
        if self.which == "KEYFRAMES":
            straighten_unposed(settings)
        assign_action(settings.armature, action)
        return None


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_reconstruct, KEYMARK_OT_show_action))
