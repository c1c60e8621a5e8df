"""The job of a detector: one clip through the user's program to keypoints that are read and checked.

The command line and the operator *Detect Keypoints* share it. Closing it ends the program and all that it has
started, and removes the folder that it wrote into.
"""

import os
import tempfile
import time
from collections.abc import Generator
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

from ....core.errors import ConversionError, InputError
from ....core.footage.clips.clip import Clip
from ....core.footage.keypoints.keypoint_file import read_keypoints
from ....core.footage.keypoints.people import People
from ....core.progress import Job, Progress
from ....core.take.clip_check import LONGEST_FRAMES, open_footage
from .detector_command import FOLDER
from .detector_output import OUTPUT_NAME, find_output, folder_excess
from .detector_process import DetectorProcess
from .detector_setting import Detector
from .progress_lines import ProgressLines

LONGEST_SAID_BYTES = 16 * 2**20
"""Of a program's words on both standard streams."""
POLL_S = 0.04
"""The job sleeps so long between two looks: short enough for a user interface to stay alive."""
FOLDER_CHECK_S = 1.0
COUNTED_SHARE, RUN_SHARE = 0.04, 0.95
"""Of the progress, at which the frames are counted, and the program has ended."""
FRAMES_A_STEP = 100
COUNTING, DETECTING, READING = "Counting the frames", "Detecting keypoints", "Reading the keypoints"


@dataclass(frozen=True, eq=False)
class Detection:
    """What a detector found in a clip."""

    people: People
    """One entry of `frames` for each frame of the clip."""
    fps: float
    """Of the clip."""
    frame_start: int
    """Number of the clip's first frame."""
    notes: tuple[str, ...] = ()
    """Sentences on what looks wrong."""

    @property
    def seen_frames(self) -> int:
        """Number of frames in which somebody was found."""
        return sum(len(frame.pixel) > 0 for frame in self.people.frames)


def detect_keypoints(
    clip_path: Path, detector: Detector, *, fps: float | None = None, frame_start: int = 1
) -> Job[Detection]:
    """Run a detector on a clip.

    Args:
        clip_path: A video, or a folder or pattern of images.
        detector: The program, and how long it may take.
        fps: Frames per second of images; a video has its own.
        frame_start: Number of the clip's first frame.

    Raises:
        InputError: The clip cannot be read, the program cannot be started, or its keypoints are unusable.
        ConversionError: The program failed, took too long, wrote nothing or too much.
    """
    yield Progress(COUNTING, 0.0)
    clip = open_footage(clip_path, fps)
    count = yield from _frame_count(clip)
    with tempfile.TemporaryDirectory(prefix="keymark-detect-", ignore_cleanup_errors=True) as name:
        root = Path(os.path.realpath(name))
        folder, logs = root / "keypoints", root / "words"
        folder.mkdir()
        logs.mkdir()
        before = _Beside(clip_path)
        process = DetectorProcess(
            detector.command.call(_values(clip, count, frame_start, folder)),
            folder,
            logs,
            detector.command.origin,
        )
        try:
            yield from _watch(process, folder, clip, count, detector)
        finally:
            process.stop()
        if process.status:
            raise ConversionError(f"{clip_path}: the detector {detector.command.name} {process.ending}")
        yield Progress(READING, RUN_SHARE)
        before.check_clip(detector.command.name)
        written = find_output(folder, detector.command.name, clip_path)
        people = _read(written, clip, count, frame_start, detector.command.name)
    notes = (*people.notes, *before.notes(detector.command.name))
    return Detection(people, clip.fps, frame_start, notes)


def _frame_count(clip: Clip) -> Job[int]:
    """Count the frames that can be decoded: a file's own number may be wrong."""
    count = 0
    for count, _ in enumerate(islice(clip.source.time_stamps(), LONGEST_FRAMES + 1), 1):
        if count % FRAMES_A_STEP == 0:
            yield Progress(COUNTING, COUNTED_SHARE * min(count / max(clip.frame_count, 1), 1.0))
    if count == 0:
        raise InputError(f"{clip.path}: holds no frame that can be decoded; it must be a video or images")
    if count > LONGEST_FRAMES:
        raise InputError(f"{clip.path}: has more than {LONGEST_FRAMES} frames; cut it into shorter clips")
    return count


def _values(clip: Clip, count: int, frame_start: int, folder: Path) -> dict[str, str]:
    """The text for each placeholder of a command."""
    width, height = clip.size
    return {
        "clip": str(clip.path.absolute()),
        "output": str(folder / OUTPUT_NAME),
        "output_folder": str(folder),
        "width": str(width),
        "height": str(height),
        "fps": f"{clip.fps:.6g}",
        "frames": str(count),
        "frame_start": str(frame_start),
        "detectors": str(FOLDER),
    }


def _watch(
    process: DetectorProcess, folder: Path, clip: Clip, count: int, detector: Detector
) -> Generator[Progress, None, None]:
    """Follow a program to its end, within its limits."""
    lines, began = ProgressLines(count), time.monotonic()
    looked = began
    where = f"{clip.path}: the detector {detector.command.name} was stopped"
    while True:
        ended = process.ended_within(POLL_S)
        now = time.monotonic()
        if process.said_bytes > LONGEST_SAID_BYTES:
            raise ConversionError(f"{where}: it said more than {LONGEST_SAID_BYTES // 2**20} MiB of text")
        if ended or now > looked + FOLDER_CHECK_S:
            looked = now
            excess = folder_excess(folder)
            if excess:
                raise ConversionError(f"{where}: it wrote {excess}")
        if ended:
            return
        if now > began + detector.time_limit_s:
            last = f", and last said: {process.last_words}" if process.last_words else ""
            raise ConversionError(
                f"{where} after {detector.time_limit_s / 60.0:.3g} minutes, the time limit that is set{last}"
            )
        done = COUNTED_SHARE + (RUN_SHARE - COUNTED_SHARE) * lines.read(process.new_text())
        yield Progress(DETECTING, done)


def _read(path: Path, clip: Clip, count: int, frame_start: int, name: str) -> People:
    """Read what the program wrote, checked against the clip."""
    try:
        people = read_keypoints(path, count, clip.size, fps=clip.fps, frame_start=frame_start)
    except InputError as error:
        sentence = str(error).replace(str(path), path.name)
        raise InputError(f"{clip.path}: the detector {name} wrote what is unusable: {sentence}") from error
    return replace(
        people,
        source=name if people.source == path.name else people.source,
        file="",
    )


class _Beside:
    """The clip and the names beside it before a program runs, to see what it does outside its folder."""

    def __init__(self, clip: Path) -> None:
        self._clip = clip
        self._names = self._listed()
        self._state = self._clip_state()

    def check_clip(self, detector: str) -> None:
        """Refuse the work of a program that has changed the clip it was given.

        Raises:
            ConversionError: It has.
        """
        if self._clip_state() != self._state:
            raise ConversionError(
                f"{self._clip}: the clip changed while the detector {detector} ran; it must only read it"
            )

    def notes(self, detector: str) -> tuple[str, ...]:
        """A sentence on what appeared beside the clip meanwhile."""
        new = sorted(self._listed() - self._names)
        if not new:
            return ()
        return (
            (
                f"{self._clip.with_name(new[0])} appeared while the detector {detector} ran; its "
                "command should hand it {output} or {output_folder} for all that it writes"
            ),
        )

    def _listed(self) -> set[str]:
        try:
            return {name for name in os.listdir(self._clip.parent) if not name.startswith(".")}
        except OSError:
            return set()

    def _clip_state(self) -> tuple[int, int] | None:
        try:
            state = self._clip.stat()
        except OSError:  # a pattern of images
            return None
        return state.st_size, state.st_mtime_ns
