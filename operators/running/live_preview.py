"""The actor follows a job while it runs: posed as far as the motion is known, and afterwards as before."""

from contextlib import ExitStack, suppress
from math import floor
from typing import TYPE_CHECKING, Any

import bpy
from bpy.app import handlers

if TYPE_CHECKING:
    from ...core.progress import Preview

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
        self._begin()
        self._scene.frame_set(floor(frame), subframe=frame - floor(frame))
        write_posture(self._armature, preview.posture[place])

    def end(self) -> None:
        """Give the scene its frame and the armature its Action and its pose back."""
        changes, self._changes = self._changes, None
        if self._before_saving in handlers.save_pre:
            handlers.save_pre.remove(self._before_saving)
        if changes is not None:
            # Undo, or another file, has brought back what was before already.
            with suppress(ReferenceError):
                changes.close()

    def _begin(self) -> None:
        from ..bridge.scene_frames import at_scene_frame, showing_action

        if self._changes is None:
            self._changes = ExitStack()
            # The pose comes back last: going to a frame would undo what is posed and not keyed.
            self._changes.enter_context(showing_action(self._armature, None))
            self._changes.enter_context(at_scene_frame(self._scene))
            handlers.save_pre.append(self._before_saving)

    def _before_saving(self, *_: object) -> None:
        """A file that is saved meanwhile holds nothing of the preview."""
        self.end()
