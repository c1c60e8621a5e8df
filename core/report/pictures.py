"""All pictures of a result, written to a folder."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..footage.clips.clip import Clip
from ..footage.tracks import RegionTracks
from ..motion import Motion
from ..take import Take
from .canvas import write_png
from .contact_sheet import chosen_frames
from .overlay_sheet import overlay_sheet
from .speed_plot import speed_plot
from .view_sheet import view_sheet

VIEWS = ("front", "side", "top")
PICTURES = ("speed.png", "overlay.png", *(f"{view}.png" for view in VIEWS))
"""Names of the pictures."""


def write_pictures(
    folder: Path, take: Take, motion: Motion, tracks: RegionTracks, speed: NDArray[np.float64]
) -> tuple[Path, ...]:
    """Write `speed.png`, `overlay.png` and the views; one more pass over the clip fetches the frames shown.

    Args:
        folder: Where to; made if missing.
        take: The take.
        motion: Its motion, F frames.
        tracks: The markers' regions.
        speed: (F,) V_sum [px/frame].

    Returns:
        The files, in the order of `PICTURES`.

    Raises:
        OSError: A picture cannot be written.
        InputError: The clip can no longer be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    frames = chosen_frames(len(motion.time_s))
    shown = dict(Clip.open(take.clip, fps=take.fps).source.at(frames))
    pictures = {
        "speed.png": speed_plot(speed, motion.keyframe_indices, motion.frame_start),
        "overlay.png": overlay_sheet(take, motion, tracks, shown),
        **{f"{view}.png": view_sheet(view, motion, take.camera, frames) for view in VIEWS},
    }
    for name in PICTURES:
        write_png(str(folder / name), pictures[name])
    return tuple(folder / name for name in PICTURES)
