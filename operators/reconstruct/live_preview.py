"""What a reconstruction shows on the actor while it runs, and what it writes into the scene at the end."""

from contextlib import ExitStack, suppress
from math import floor

import bpy
import numpy as np
from bpy.app import handlers
from bpy.types import Object, PropertyGroup, Scene

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.estimate.reconstruct import Reconstruction
from ...core.markers.reading import Reading
from ...core.progress import Preview
from ...core.review.review import Review
from ..bridge.fcurves import write_motion
from ..bridge.pose import write_posture
from ..bridge.scene_frames import at_scene_frame, showing_action
from ..keyframes.scene_session import SceneSession
from ..shell.results import clear_review, keep_reading, keep_review
from ..shell.take_state import digest_of
from ..shell.takes import actor_of, take_by_identifier

ENDS = ("save_pre", "undo_pre", "redo_pre", "load_pre")
"""Handlers before which the preview is undone: files must not hold it, and these events move data blocks."""


class LivePreview:
    """Shows previews on an armature in its scene; `end` leaves both as they were."""

    def __init__(self, scene: Scene, armature_object: Object, frames: Array) -> None:
        """Change nothing before the first preview; `frames` (F,) are the scene frames of the clip's."""
        self._scene, self._armature, self._frames = scene, armature_object, frames
        self._uids = scene.session_uid, armature_object.session_uid
        self._changes: ExitStack | None = None
        self._shown = -1

    def show(self, preview: Preview) -> None:
        """Show one frame of a preview; from one preview to the next the actor moves on."""
        count = preview.posture.batch[0]
        step = max(1, count // 9)  # the actor goes through all frames in nine steps
        inside = preview.first <= self._shown < preview.first + count
        row = (self._shown - preview.first + step) % count if inside else 0
        self._shown = preview.first + row
        frame = float(self._frames[min(self._shown, len(self._frames) - 1)])
        if self._changes is None:
            self._begin()
        self._scene.frame_set(floor(frame), subframe=frame - floor(frame))
        write_posture(self._armature, preview.posture[row])

    def end(self) -> None:
        """Give the scene its frame and the armature its Action and its pose back."""
        for name in ENDS:
            if self._restore in getattr(handlers, name):
                getattr(handlers, name).remove(self._restore)
        self._restore()

    def _restore(self, *_: object) -> None:
        """Undo the preview; as a handler it must not remove itself, or Blender would skip the next one."""
        changes, self._changes = self._changes, None
        if changes is not None:
            # Undo, or another file, has restored the scene already.
            with suppress(ReferenceError):
                changes.close()

    def _begin(self) -> None:
        # Undo may have replaced both in memory.
        found = [
            next((item for item in items if item.session_uid == uid), None)
            for items, uid in zip((bpy.data.scenes, bpy.data.objects), self._uids, strict=True)
        ]
        if None in found:
            raise InputError(
                "the actor or the scene that the job was about has been removed meanwhile; run it again"
            )
        self._scene, self._armature = found
        self._changes = ExitStack()
        # The pose comes back last: going to a frame would undo what is posed and not keyed.
        self._changes.enter_context(showing_action(self._armature, None))
        self._changes.enter_context(at_scene_frame(self._scene))
        for name in ENDS:
            if self._restore not in getattr(handlers, name):
                getattr(handlers, name).append(self._restore)


def write_result(scene: Scene, made: SceneSession, judged: Review) -> PropertyGroup:
    """Write a motion and its review, and let its Action animate the actor; return the take."""
    take, result = take_by_identifier(scene, made.take), made.session[Reconstruction]
    take.motion_action = write_motion(
        actor_of(take), result.motion, take.motion_action, take.keyframe_action, made.frames
    )
    take.motion_action.use_fake_user = True
    take.made_from = made.keyframes or digest_of(take.keyframe_action)
    keep_reading(take, made.session[Reading])
    keep_review(take, judged)
    show_review(take, judged)
    return take


def show_review(take: PropertyGroup, review: Review) -> None:
    """Fill the review of a take whose motion was written."""
    shown = take.review
    clear_review(take)
    shown.frame_count = len(review.frames)
    known = review.confidence[np.isfinite(review.confidence)]
    shown.confidence = float(known.mean()) if len(known) else -1.0  # the method cannot tell
    for weak in review.weak_frames:
        item = shown.weak_frames.add()
        item.frame = review.frames[weak.index]
        item.reason = weak.reason.name
        item.marker = "" if weak.marker is None else review.marker_names[weak.marker]
        item.point = weak.point or ""
