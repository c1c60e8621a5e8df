"""The actor follows a job while it runs: posed as far as the motion is known, and afterwards as before."""

from contextlib import ExitStack, suppress
from math import floor
from typing import TYPE_CHECKING, Any

import bpy
from bpy.app import handlers

from ...core.errors import InputError
from ..bridge.scene_frames import at_scene_frame, showing_action

if TYPE_CHECKING:
    from ...core.progress import Preview

ENDS = ("save_pre", "undo_pre", "redo_pre", "load_pre")
"""Before these the preview is taken back: no file holds it, and they move what it refers to in memory."""
SWEEPS = 9
"""Pictures in which the actor goes through the frames of a preview."""


class LivePreview:
    """Shows previews on an armature in its scene; `end` leaves both as they were."""

    def __init__(self, scene: bpy.types.Scene, armature_object: bpy.types.Object, frames: Any) -> None:
        """Prepare; nothing is changed before the first preview.

        Args:
            scene: Where the clip's frames are gone to.
            armature_object: The actor.
            frames: (F,) scene frame of every frame of the clip.
        """
        self._scene, self._armature, self._frames = scene, armature_object, frames
        self._uids = scene.session_uid, armature_object.session_uid
        self._changes: ExitStack | None = None
        self._shown = -1

    def show(self, preview: "Preview") -> None:
        """Show the next of a preview's frames: from one preview to the next the actor moves on."""
        from ..bridge.pose import write_posture

        count = preview.posture.batch[0]
        step = max(1, count // SWEEPS)
        inside = preview.first <= self._shown < preview.first + count
        place = (self._shown - preview.first + step) % count if inside else 0
        self._shown = preview.first + place
        frame = float(self._frames[min(self._shown, len(self._frames) - 1)])
        if self._changes is None:
            self._begin()
        self._scene.frame_set(floor(frame), subframe=frame - floor(frame))
        write_posture(self._armature, preview.posture[place])

    def end(self) -> None:
        """Give the scene its frame and the armature its Action and its pose back."""
        for name in ENDS:
            if self._take_back in getattr(handlers, name):
                getattr(handlers, name).remove(self._take_back)
        self._take_back()

    def _take_back(self, *_: object) -> None:
        """Leave nothing of the preview; the next one begins anew.

        Called by Blender it must not remove itself, or Blender would pass over the handler that comes next.
        """
        changes, self._changes = self._changes, None
        if changes is not None:
            # Undo, or another file, has brought back what was before already.
            with suppress(ReferenceError):
                changes.close()

    def _begin(self) -> None:
        # Undo may have put others in their place.
        self._scene, self._armature = (
            _of_uid(items, uid)
            for items, uid in zip((bpy.data.scenes, bpy.data.objects), self._uids, strict=True)
        )
        self._changes = ExitStack()
        # The pose comes back last: going to a frame would undo what is posed and not keyed.
        self._changes.enter_context(showing_action(self._armature, None))
        self._changes.enter_context(at_scene_frame(self._scene))
        for name in ENDS:
            if self._take_back not in getattr(handlers, name):
                getattr(handlers, name).append(self._take_back)


def _of_uid(items: "bpy.types.bpy_prop_collection[Any]", uid: int) -> Any:
    """What had this number when the job began, whatever it is called by now.

    Raises:
        InputError: It is gone.
    """
    for item in items:
        if item.session_uid == uid:
            return item
    raise InputError("the actor or the scene that the job was about has been removed meanwhile; run it again")
