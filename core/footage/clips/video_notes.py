"""Notes on a video file's header: non-square pixels and high dynamic range."""

from pathlib import Path

import cv2

from .video_color import dynamic_range

NOTICEABLE_SHAPE = 0.01


def video_notes(path: Path, capture: cv2.VideoCapture) -> tuple[str, ...]:
    """Sentences on faults of an open video."""
    return (*_shape_notes(path, capture), *_range_notes(path))


def _shape_notes(path: Path, capture: cv2.VideoCapture) -> tuple[str, ...]:
    across, down = capture.get(cv2.CAP_PROP_SAR_NUM), capture.get(cv2.CAP_PROP_SAR_DEN)
    if not (across > 0.0 and down > 0.0) or abs(across / down - 1.0) < NOTICEABLE_SHAPE:
        return ()
    return (
        f"the pixels of {path.name} are {across / down:.3g} times as wide as high, and Keymark and Blender "
        "take them for square: the motion is out of shape; convert the clip first, as with ffmpeg -i CLIP "
        "-vf scale=iw*sar:ih,setsar=1",
    )


def _range_notes(path: Path) -> tuple[str, ...]:
    transfer = dynamic_range(path)
    if transfer is None:
        return ()
    return (
        f"{path.name} is of high dynamic range ({transfer}): read as it is, its colors are pale and markers "
        "harder to tell apart; film in standard range or convert it, and pick the markers' colors anew",
    )
