"""The pictures of a result, written to a folder."""

from pathlib import Path

from ..errors import InputError
from ..footage.clips.clip import Clip
from ..footage.region_tracks import RegionTracks
from ..observation.contours import ContourModel
from ..review.compared_keypoints import ComparedKeypoints
from ..take.motion import Motion
from ..take.take import Take
from .canvas import write_png
from .contact_sheet import evenly_spaced_frames
from .footage_frames import footage_frames
from .overlay_sheet import overlay_sheet
from .side_sheet import side_sheet

OVERLAY, SIDE = "overlay.png", "side.png"
PICTURES = (OVERLAY, SIDE)
EARLIER_PICTURES = ("speed.png", "front.png", "top.png", "matches.png", "strip.jpg")
"""Pictures of 0.1.0, which a conversion into the same folder removes."""


def write_pictures(
    folder: Path,
    take: Take,
    motion: Motion,
    tracks: RegionTracks,
    keypoints: ComparedKeypoints | None = None,
    contours: ContourModel | None = None,
) -> tuple[Path, ...]:
    """Write the pictures; the frames that they show are decoded in one more pass over the clip.

    Args:
        folder: Made if missing.
        take: The take.
        motion: Its motion, F frames.
        tracks: The markers' regions.
        keypoints: The performer's keypoints, if any.
        contours: The body's contours, drawn where there are no markers.

    Returns:
        Paths of the files, in the order of `PICTURES`.

    Raises:
        OSError: A picture cannot be written.
        InputError: The clip can no longer be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    frames = evenly_spaced_frames(len(motion.time_s))
    shown = footage_frames(Clip.open(take.clip, fps=take.fps), frames)
    if not shown:
        raise InputError(f"{take.clip}: can no longer be read; the pictures need it once more")
    write_png(str(folder / OVERLAY), overlay_sheet(take, motion, tracks, shown, keypoints, contours))
    write_png(str(folder / SIDE), side_sheet(motion, take.camera, frames))
    return tuple(folder / name for name in PICTURES)
