"""A take enlarged and lengthened: the clip that a camera of today would have filmed.

Its pictures are enlarged by one factor, with their edges repeated at the sides, get camera noise, without
which they would decode more easily than filmed ones, and are played forward and backward in turn. Camera,
keyframes and keypoints are brought along.
"""

import json
import math
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import imageio_ffmpeg
from takes import load_project

load_project()

from keymark.core.camera.camera import Camera  # noqa: E402
from keymark.core.files.json_file import write_json  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.take.evidence import CONTOURS, MARKERS  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take, write_take  # noqa: E402

Size = tuple[int, int]
KEYPOINTS = "keypoints.json"
ENCODED = ("-pix_fmt", "yuv420p", "-c:v", "libx264", "-preset", "superfast", "-b:v", "17M", "-bf", "0")
"""H.264 of a telephone's bit rate; no picture depends on a later one, so that the stream can be repeated."""
NOISE = "noise=alls=6:allf=t"


def lengthened(folder: Path, repeats: int, place: Path) -> Path:
    """Make a take that plays `folder`'s clip `repeats` times, forward and backward in turn."""
    take = read_take(folder)
    images, capture = [], cv2.VideoCapture(str(take.clip))
    while True:
        ok, image = capture.read()
        if not ok:
            break
        images.append(image)
    count = len(images)
    place.mkdir()
    video = cv2.VideoWriter(
        str(place / "clip.mp4"), cv2.VideoWriter.fourcc(*"mp4v"), take.fps, take.camera.resolution
    )
    keyframes = []
    for turn in range(repeats):
        backwards = turn % 2 == 1
        for image in reversed(images) if backwards else images:
            video.write(image)
        for keyframe in take.keyframes:
            index = count - 1 - keyframe.index if backwards else keyframe.index
            keyframes.append(Keyframe(turn * count + index, keyframe.posture))
    video.release()
    keyframes.sort(key=lambda keyframe: keyframe.index)
    long = Take(
        place, place / "clip.mp4", take.fps, take.frame_start, count * repeats, take.camera, take.body,
        take.markers, tuple(keyframes),
    )  # fmt: skip
    write_take(long, place)
    return place


def enlarged(folder: Path, size: Size, frames: int, place: Path) -> Path:
    """Make a take of `frames` frames of `size` pixels from the one in `folder`.

    Args:
        folder: A take with keyframes and a file of keypoints, by the names of `keypoint_format.md`.
        size: Width and height; the smaller enlargement of the two counts.
        frames: Number of frames.
        place: The new folder.
    """
    short = read_take(folder)
    count = json.loads((folder / "take.json").read_text(encoding="utf-8"))["frame_count"]
    factor, margin = fit(short.camera.resolution, size)
    place.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as temporary:
        long = read_take(lengthened(folder, math.ceil(frames / count), Path(temporary) / "long"))
        _write_clip(long.clip, size, margin, min(2 * count, frames), frames, place / "clip.mp4")
    said = json.loads((folder / KEYPOINTS).read_text(encoding="utf-8"))
    order = [shown(index, count) for index in range(frames)]
    said["frames"] = [
        points and [_moved(point, factor, margin) for point in points]
        for points in (said["frames"][index] for index in order)
    ]
    if "world" in said:  # guesses of the points in space, which no enlargement changes
        said["world"] = [said["world"][index] for index in order]
    write_json(place / KEYPOINTS, {**said, "size": list(size)})
    take = replace(
        long,
        folder=place,
        clip=place / "clip.mp4",
        frame_count=frames,
        camera=seen_larger(short.camera, size),
        keyframes=tuple(each for each in long.keyframes if each.index < frames),
    )
    write_take(take, place, evidence=(MARKERS, CONTOURS))
    return place


def shown(index: int, count: int) -> int:
    """The frame of a clip of `count` that is shown at `index` when it plays forward and backward in turn."""
    turn, within = divmod(index, count)
    return count - 1 - within if turn % 2 else within


def fit(old: Size, new: Size) -> tuple[float, tuple[float, float]]:
    """Factor by which a picture is enlarged, and the margins on the left and above [px]."""
    factor = min(new[0] / old[0], new[1] / old[1])
    return factor, (0.5 * (new[0] - factor * old[0]), 0.5 * (new[1] - factor * old[1]))


def seen_larger(camera: Camera, size: Size) -> Camera:
    """The camera whose picture is the enlarged one with its margins."""
    factor, _ = fit(camera.resolution, size)
    wider = size[0] / (factor * camera.resolution[0])
    return replace(camera, resolution=size, sensor_width_mm=wider * camera.sensor_width_mm)


def _moved(point: list[Any] | None, factor: float, margin: tuple[float, float]) -> list[Any] | None:
    if point is None or point[0] is None:
        return point
    return [factor * point[0] + margin[0], factor * point[1] + margin[1], *point[2:]]


def _write_clip(
    source: Path, size: Size, margin: tuple[float, float], encoded: int, frames: int, target: Path
) -> None:
    """Enlarge a clip's first frames, and repeat what was encoded until there are `frames`."""
    (width, height), (across, down) = size, map(round, margin)
    filters = (
        f"scale={width - 2 * across}:{height - 2 * down}:flags=bicubic",
        f"pad={width}:{height}:{across}:{down}",
        f"fillborders={across}:{across}:{down}:{down}:smear",
        NOISE,
    )
    with tempfile.TemporaryDirectory() as temporary:
        once = Path(temporary) / "once.mp4"
        _ffmpeg("-i", source, "-vf", ",".join(filters), "-frames:v", encoded, *ENCODED, once)
        repeats = math.ceil(frames / encoded) - 1
        _ffmpeg("-stream_loop", repeats, "-i", once, "-c", "copy", "-frames:v", frames, target)


def _ffmpeg(*words: object) -> None:
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", *map(str, words)]
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL)
