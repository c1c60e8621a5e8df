"""All pictures of a result, written to a folder."""

from pathlib import Path

from ..arrays import Array
from ..errors import InputError
from ..footage.clips.clip import Clip
from ..footage.region_tracks import RegionTracks
from ..observation.contours import ContourModel
from ..review.compared_keypoints import ComparedKeypoints
from ..take.motion import Motion
from ..take.take import Take
from .canvas import write_jpg, write_png
from .contact_sheet import evenly_spaced_frames
from .film_strip import film_strip
from .footage_frames import footage_frames
from .match_sheet import match_sheet, shown_keyframes
from .overlay_sheet import overlay_sheet
from .speed_plot import speed_plot
from .strip_layout import PICTURES as STRIP_FRAMES
from .strip_layout import STRIP
from .view_sheet import view_sheet

VIEWS = ("front", "side", "top")
PICTURES = ("speed.png", "overlay.png", *(f"{view}.png" for view in VIEWS), STRIP)
"""Names of the pictures."""
MATCHES = "matches.png"
"""One more picture, where keyframes were found in the footage."""


def write_pictures(
    folder: Path,
    take: Take,
    motion: Motion,
    tracks: RegionTracks,
    speed: Array,
    keypoints: ComparedKeypoints | None = None,
    contours: ContourModel | None = None,
) -> tuple[Path, ...]:
    """Write all pictures; the frames that they show are decoded in one more pass over the clip.

    Args:
        folder: Folder for the pictures; made if missing.
        take: The take.
        motion: Its motion, F frames.
        tracks: The markers' regions.
        speed: (F,) V_sum [px/frame].
        keypoints: The performer's keypoints, if any.
        contours: The body's contours, drawn where there are no markers.

    Returns:
        Paths of the files in the order of `PICTURES`, then of `MATCHES` if it is written.

    Raises:
        OSError: A picture cannot be written.
        InputError: The clip can no longer be read.
    """
    folder.mkdir(parents=True, exist_ok=True)
    frames = evenly_spaced_frames(len(motion.time_s))
    matched = any(keyframe.matched is not None for keyframe in take.keyframes)
    keyed = [keyframe.index for keyframe in shown_keyframes(take)] if matched else []
    in_strip = evenly_spaced_frames(len(motion.time_s), STRIP_FRAMES)
    wanted = sorted({*frames, *in_strip, *keyed})
    shown = footage_frames(Clip.open(take.clip, fps=take.fps), wanted)
    found = {frame: shown[frame] for frame in frames if frame in shown}
    if not found:
        raise InputError(f"{take.clip}: can no longer be read; the pictures need it once more")
    pictures = {
        "speed.png": speed_plot(speed, motion.keyframe_indices, motion.frame_start),
        "overlay.png": overlay_sheet(take, motion, tracks, found, keypoints, contours),
        **{f"{view}.png": view_sheet(view, motion, take.camera, frames) for view in VIEWS},
    }
    if matched:
        pictures[MATCHES] = match_sheet(take, shown)
    for name, picture in pictures.items():
        write_png(str(folder / name), picture)
    strip = {frame: shown[frame] for frame in in_strip if frame in shown}
    write_jpg(str(folder / STRIP), film_strip(take, motion, strip))
    matches = (MATCHES,) if matched else ()
    return tuple(folder / name for name in (*PICTURES, *matches))
