"""Keypoints of one person by MediaPipe Pose, as a file that Keymark reads.

A program of its own, which imports nothing of Keymark: it runs in a virtual environment with what
`mediapipe_pose.txt` lists, whose OpenCV would clash with Keymark's. The network comes with pip's `mediapipe`;
nothing is downloaded here.

    python mediapipe_pose.py CLIP --output keypoints.json

Exit status: 0 done, 1 the network failed, 2 the clip or the options are unusable; on all but 0 the last line
on standard error says why, and no file is written.
"""

import argparse
import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

POINTS = 33
LAYOUT = "blazepose33"
MODELS = {"lite": 0, "full": 1, "heavy": 2}
"""Names of the landmark networks and MediaPipe's own numbers for them; pip's distribution holds `full`."""
PIXEL_DIGITS, SCORE_DIGITS, METER_DIGITS = 2, 3, 4
IMAGES = frozenset({".bmp", ".jpeg", ".jpg", ".png", ".tif", ".tiff", ".webp"})
FAILED, UNUSABLE = 1, 2


class StopError(Exception):
    """An end of the program: its exit status, and a sentence that says why."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status


class OneLineParser(argparse.ArgumentParser):
    """A parser that tells a mistake in one sentence."""

    def error(self, message: str) -> NoReturn:
        """Raise instead of writing the usage."""
        raise StopError(UNUSABLE, f"{message}; see --help")


class Frames:
    """The pictures of a video or of a folder of numbered images, blue first, in order."""

    def __init__(self, path: Path) -> None:
        """Open the clip.

        Raises:
            StopError: There is no such clip, or it cannot be decoded.
        """
        import cv2

        self._cv2 = cv2
        self._images: list[Path] = []
        self._video: Any = None
        self.fps = 0.0
        if path.is_dir():
            files = (file for file in path.iterdir() if file.suffix.lower() in IMAGES)
            self._images = sorted((file for file in files if file.name[:1] != "."), key=_by_number)
            if not self._images:
                raise StopError(UNUSABLE, f"{path}: holds no images; a clip is a video or a folder of images")
            self.count = len(self._images)
            return
        if not path.is_file():
            raise StopError(UNUSABLE, f"{path}: no such file; a clip is a video or a folder of images")
        self._video = cv2.VideoCapture(str(path))
        self._video.set(cv2.CAP_PROP_ORIENTATION_AUTO, 1)  # as Blender and Keymark turn it
        if not self._video.isOpened():
            raise StopError(UNUSABLE, f"{path}: cannot be decoded; a clip is a video or a folder of images")
        self.fps = float(self._video.get(cv2.CAP_PROP_FPS))
        self.count = int(self._video.get(cv2.CAP_PROP_FRAME_COUNT))

    def __iter__(self) -> Iterator[Any]:
        """Yield each picture, (height, width, 3) uint8."""
        if self._video is None:
            for file in self._images:
                picture = self._cv2.imread(str(file), self._cv2.IMREAD_COLOR)
                if picture is None:
                    raise StopError(UNUSABLE, f"{file}: cannot be decoded; it must be an image")
                yield picture
            return
        while True:
            is_read, picture = self._video.read()
            if not is_read:
                return
            yield picture


def parse(words: list[str]) -> argparse.Namespace:
    """The options of the command line.

    Raises:
        StopError: They are unusable.
    """
    parser = OneLineParser(
        prog="mediapipe_pose.py", description="Finds the keypoints of one person with MediaPipe Pose."
    )
    parser.add_argument("clip", metavar="CLIP", type=Path, help="video, or folder of numbered images")
    parser.add_argument("--output", "-o", metavar="FILE", type=Path, required=True, help="keypoint file")
    parser.add_argument(
        "--model",
        choices=tuple(MODELS),
        default="full",
        help="landmark network; pip's mediapipe holds full, the others are used where their file was added",
    )
    parser.add_argument(
        "--region",
        metavar=("X", "Y", "WIDTH", "HEIGHT"),
        type=int,
        nargs=4,
        help="search this part of the picture alone, as for one of several people [pixels]",
    )
    parser.add_argument(
        "--still-images", action="store_true", help="search each picture anew instead of following the person"
    )
    parser.add_argument(
        "--no-smoothing", action="store_true", help="leave out MediaPipe's own filter over time"
    )
    parser.add_argument("--no-world", action="store_true", help="leave out the guess of points in space")
    parser.add_argument(
        "--detection-confidence",
        metavar="C",
        type=_share,
        default=0.5,
        help="least confidence, 0 to 1, to find a person; 0.5 is the default",
    )
    parser.add_argument(
        "--tracking-confidence",
        metavar="C",
        type=_share,
        default=0.5,
        help="least confidence, 0 to 1, to follow one without searching anew; 0.5 is the default",
    )
    parser.add_argument(
        "--frame-start", metavar="N", type=int, default=1, help="number of the first frame; 1 is the default"
    )
    return parser.parse_args(words)


def detect(options: argparse.Namespace) -> dict[str, Any]:
    """Run the network over the clip; returns the content of the keypoint file.

    Raises:
        StopError: The clip cannot be read, or the network cannot be loaded.
    """
    frames = Frames(options.clip)
    network = _network(options)
    found: list[Any] = []
    world: list[Any] = []
    size: tuple[int, int] | None = None
    for index, picture in enumerate(frames):
        height, width = picture.shape[:2]
        if size is not None and size != (width, height):
            raise StopError(
                UNUSABLE,
                f"{options.clip}: frame {index + options.frame_start} has {width} x {height} pixels; "
                f"all must have {size[0]} x {size[1]}",
            )
        size = (width, height)
        left, top, right, bottom = _part(options.region, width, height)
        part = picture[top:bottom, left:right, ::-1].copy()  # red first, as the network wants it
        result = network.process(part)
        found.append(_image_points(result, left, top, right - left, bottom - top))
        world.append(_space_points(result))
        print(f"frame {index + 1}/{max(frames.count, index + 1)}", flush=True)
    if size is None:
        raise StopError(UNUSABLE, f"{options.clip}: holds no frame that can be decoded")
    content: dict[str, Any] = {
        "detector": f"MediaPipe Pose {_version()}, landmark model {options.model}",
        "layout": LAYOUT,
        "size": list(size),
    }
    if frames.fps > 0.0 and math.isfinite(frames.fps):
        content["fps"] = frames.fps
    content["frame_start"] = options.frame_start
    content["frames"] = found
    if not options.no_world:
        content["world"] = world
    return content


def write(path: Path, content: dict[str, Any]) -> None:
    """Write the file whole or not at all.

    Raises:
        StopError: It cannot be written.
    """
    text = json.dumps(content, allow_nan=False, separators=(",", ":")) + "\n"
    beside = ""
    try:
        descriptor, beside = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with open(descriptor, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(beside, 0o644)
        os.replace(beside, path)
    except OSError as error:
        if beside and os.path.exists(beside):
            os.remove(beside)
        raise StopError(FAILED, f"{path}: cannot be written ({error.strerror or error})") from error


def _network(options: argparse.Namespace) -> Any:
    """MediaPipe's Pose."""
    os.environ.setdefault("GLOG_minloglevel", "2")  # its greetings are no errors
    try:
        import mediapipe
    except ImportError as error:
        raise StopError(
            FAILED,
            f"mediapipe cannot be loaded ({error}); install {Path(__file__).with_suffix('.txt').name} "
            "into a virtual environment and run this program with its Python",
        ) from error
    folder = Path(mediapipe.__file__).parent / "modules" / "pose_landmark"
    model = folder / f"pose_landmark_{options.model}.tflite"
    if not model.is_file():  # else MediaPipe would download it
        raise StopError(UNUSABLE, f"--model is {options.model}; {model} is missing, and full is always there")
    return mediapipe.solutions.pose.Pose(
        static_image_mode=options.still_images,
        model_complexity=MODELS[options.model],
        smooth_landmarks=not options.no_smoothing,
        min_detection_confidence=options.detection_confidence,
        min_tracking_confidence=options.tracking_confidence,
    )


def _version() -> str:
    from importlib.metadata import version

    return version("mediapipe")


def _image_points(result: Any, left: int, top: int, width: int, height: int) -> list[list[float]] | None:
    """x, y and score of each point in pixels of the whole picture; None where nobody was found."""
    if result.pose_landmarks is None:
        return None
    return [
        [
            round(left + point.x * width, PIXEL_DIGITS),
            round(top + point.y * height, PIXEL_DIGITS),
            round(point.visibility, SCORE_DIGITS),
        ]
        for point in result.pose_landmarks.landmark
    ]


def _space_points(result: Any) -> list[list[float]] | None:
    """x to the right, y down and z away from the camera of each point [m], from between the hips."""
    if result.pose_world_landmarks is None:
        return None
    return [
        [round(value, METER_DIGITS) for value in (point.x, point.y, point.z)]
        for point in result.pose_world_landmarks.landmark
    ]


def _part(region: list[int] | None, width: int, height: int) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of the part that is searched."""
    if region is None:
        return 0, 0, width, height
    left, top, across, down = region
    if min(left, top) < 0 or min(across, down) < 1 or left + across > width or top + down > height:
        raise StopError(
            UNUSABLE,
            f"--region is {' '.join(map(str, region))}; it must lie within {width} x {height} pixels",
        )
    return left, top, left + across, top + down


def _share(text: str) -> float:
    value = float(text)
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1")
    return value


def _by_number(file: Path) -> list[tuple[int, str]]:
    """Sorts img_2 before img_10."""
    parts = re.split(r"(\d+)", file.name)
    return [(int(part), "") if part.isdigit() else (-1, part) for part in parts]


def main(words: list[str]) -> int:
    """Detect and write; returns the exit status."""
    try:
        options = parse(words)
        write(options.output, detect(options))
    except StopError as stop:
        print(f"mediapipe_pose.py: {stop}", file=sys.stderr)
        return stop.status
    except KeyboardInterrupt:
        print("mediapipe_pose.py: interrupted; nothing was written", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
