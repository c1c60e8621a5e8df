"""Find keypoints in the clip by Keymark's own network."""

from dataclasses import dataclass
from os import W_OK, X_OK, access
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.job_operator import JobOperator
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, footage_of, redraw_footage, take_by_identifier
from .evidence import add_keypoint_file, keypoint_path
from .frame_keypoints import clear_readings

if TYPE_CHECKING:
    from ...core.footage.keypoints.keypoints import People
    from ...core.progress import Job


KEYPOINT_FILE = "keypoints.json"


@dataclass(frozen=True, eq=False)
class Detected:
    """Result of the job."""

    take: str  # The take's identifier
    output: Path  # The file to write
    people: "People"
    fps: float
    frame_start: int


class KEYMARK_OT_detect_keypoints(JobOperator, bpy.types.Operator):
    """Find points of the body of everybody in the whole clip"""

    bl_idname = "keymark.detect_keypoints"
    bl_label = "Detect Keypoints"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[Detected]":
        from ...core.footage.pose_network import PoseNetwork
        from ...core.footage.pose_tracking import find_people
        from ...core.take.clip_check import LONGEST_FRAMES, open_footage

        take = active_take(scene)
        identifier, source = take.identifier, footage_of(scene, take)
        output, first = _output(take, source.path), source.first_frame
        clip = open_footage(source.path, source.rate)
        people = yield from find_people(clip, PoseNetwork(), LONGEST_FRAMES)
        return Detected(identifier, output, people, clip.fps, first)

    def finish(self, scene: bpy.types.Scene, result: Detected) -> None:
        from ...core.footage.keypoints.keypoint_file import write_keypoints

        take = take_by_identifier(scene, result.take)
        people = result.people
        write_keypoints(result.output, people, result.frame_start, result.fps)
        add_keypoint_file(take, result.output)
        take.follow.use_keypoints = True
        clear_readings()
        redraw_footage(bpy.context)
        seen = f"Somebody is seen in {people.seen_frames} of {len(people.frames)} frames"
        self.report({"INFO"}, f"{seen}; the keypoints are in {result.output.name}")


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
    names = [wanted, *(sidecar_file(clip, f"keypoints{number}.json") for number in range(2, 1000))]
    return next((name for name in names if name in known or not name.exists()), wanted)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_detect_keypoints,))
