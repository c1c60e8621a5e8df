"""Files of keypoints: our own, and those of detectors, recognized by their content."""

from pathlib import Path
from typing import Any

from ...errors import InputError
from ...files.control_characters import is_control_character
from ...files.fields import Fields
from ...files.json_file import read_json_value, shown
from .clip_fit import held_against_clip
from .coco_results import is_coco, read_coco
from .detected_frames import DetectedFrames
from .frame_folder import read_frame_folder
from .mediapipe_landmarks import is_mediapipe, read_mediapipe
from .mmpose_results import is_instances, is_mmpose, read_mmpose
from .openpose_frame import is_openpose_frame
from .own_file import read_own, write_keypoints
from .people import People

__all__ = ["LARGEST_BYTES", "read_keypoints", "write_keypoints"]

LARGEST_BYTES = 128 * 2**20
"""Twenty minutes of two people with their hints of depth."""
LONGEST_SOURCE = 200
FORMATS = (
    "Keymark's own file (with layout and frames), a folder of OpenPose's files, or a result file of MMPose, "
    "COCO or MediaPipe"
)


def read_keypoints(
    path: Path,
    frame_count: int | None,
    size: tuple[int, int],
    fps: float | None = None,
    frame_start: int = 1,
) -> People:
    """Read keypoints of a clip, whatever wrote them; `notes` says what was taken for granted.

    Args:
        path: A file, or the folder of a detector that writes one file a frame.
        frame_count: Frames of the clip; None where it is not known, then as many as the file has.
        size: Width and height of the clip's pictures [px].
        fps: Frames per second of the clip; None where it is not known.
        frame_start: Scene frame of the clip's first frame.

    Raises:
        InputError: It is no such file, is damaged, is of another clip, or shows nobody.
    """
    return held_against_clip(_read(path), frame_count, size, fps, frame_start)


def _read(path: Path) -> DetectedFrames:
    source = "".join("?" if is_control_character(char) else char for char in path.name)[:LONGEST_SOURCE]
    if path.is_dir():
        return read_frame_folder(path)
    value = read_json_value(path, LARGEST_BYTES)
    where = str(path)
    if isinstance(value, dict) and "layout" in value:
        return read_own(Fields(value, where), source)
    if is_mmpose(value):
        return read_mmpose(value, where, source)
    if is_coco(value):
        return read_coco(value, where, source)
    if is_mediapipe(value):
        return read_mediapipe(value, where, source)
    raise InputError(f"{path}: {_seen(value)}; it must be {FORMATS}")


def _seen(value: Any) -> str:
    """What a file of no known format holds."""
    if value in ([], {}):
        return "is empty"
    if is_openpose_frame(value):
        return "holds one frame of OpenPose, whose folder must be given"
    if is_instances(value):
        return "holds one picture of MMPose, whose folder must be given"
    if isinstance(value, dict):
        return f"holds an object with the fields {shown(list(value)[:8])}, which no known format has"
    return f"holds {shown(value)}"
