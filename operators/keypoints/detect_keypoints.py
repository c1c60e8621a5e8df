"""Find keypoints in the clip with the detector that the preferences name."""

from dataclasses import dataclass
from os import W_OK, X_OK, access
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.job_operator import JobOperator
from ..shell.messages import warn
from ..shell.redraw import redraw_footage
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, footage_of, take_by_identifier
from .keypoint_paths import add_keypoint_file, keypoint_path
from .keypoint_readings import clear_readings
from .requirements import detector

if TYPE_CHECKING:
    from ...core.progress import Job
    from ..bridge.detector.detect_keypoints import Detection

KEYPOINT_FILE = "keypoints.json"
MOST_TRIED = 1000
"""Numbers that are tried for a name that is free."""


@dataclass(frozen=True, eq=False)
class Detected:
    """Result of the job."""

    take: str
    """The take's identifier."""
    output: Path
    """The file to write."""
    detection: "Detection"


class KEYMARK_OT_detect_keypoints(JobOperator, bpy.types.Operator):
    """Find points of the body in the whole clip, with the detector named in Keymark's preferences"""

    bl_idname = "keymark.detect_keypoints"
    bl_label = "Detect Keypoints"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, detector, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Detected]":
        """Return the job that runs the detector; closing it ends the program, which leaves nothing behind."""
        from ..bridge.detector.detect_keypoints import detect_keypoints
        from ..shell.preferences import preferred_detector

        take = active_take(scene)
        identifier, source, chosen = take.identifier, footage_of(scene, take), preferred_detector()
        output = _output(take, source.path)
        if chosen is None:
            raise InputError("no detector is named; set one in Keymark's preferences")
        chosen.command.check_program()
        clip, rate, first = source.path, source.rate, source.first_frame
        job = detect_keypoints(clip, chosen, fps=rate, frame_start=first)
        return Detected(identifier, output, (yield from job))

    def finish(self, scene: bpy.types.Scene, result: Detected) -> None:
        """Write the keypoints beside the clip, and add them to the take."""
        from ...core.footage.keypoints.keypoint_file import write_keypoints

        take = take_by_identifier(scene, result.take)
        found = result.detection
        write_keypoints(result.output, found.people, found.frame_start, found.fps)
        add_keypoint_file(take, result.output)
        take.follow.use_keypoints = True
        clear_readings()
        redraw_footage(bpy.context)
        for note in found.notes:
            warn(self, note)
        self.report(
            {"INFO"},
            f"Somebody is seen in {found.seen_frames} of {len(found.people.frames)} frames; the "
            f"keypoints are in {result.output.name}",
        )


def _output(take: bpy.types.PropertyGroup, clip: Path) -> Path:
    """The file that the keypoints go into: beside the clip, where nothing else lies.

    Raises:
        InputError: No file can be written there.
    """
    from ...core.take.description import sidecar_file

    wanted = sidecar_file(clip, KEYPOINT_FILE)
    if not access(wanted.parent, W_OK | X_OK):
        raise InputError(f"{wanted.parent}: cannot be written; the keypoints belong beside the clip")
    known = {keypoint_path(entry) for entry in take.follow.files}
    names = [wanted, *(sidecar_file(clip, f"keypoints{number}.json") for number in range(2, MOST_TRIED))]
    return next((name for name in names if name in known or not name.exists()), wanted)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_detect_keypoints,))
