"""A take's footage: its clip opened and checked against the take, and read in one pass."""

from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np

from ..arrays import chunks
from ..detect.clip_fit import tolerance
from ..errors import InputError
from ..markers.reading import Reading, read_clip
from ..markers.region_tracks import ExpectedRegions
from ..prior.keyframes import interpolate
from ..progress import Job, Progress, within
from ..terms.region_model import MarkerPlacement, RegionModel
from ..video.album import Watch
from ..video.clip import Clip
from ..video.container import read_packets
from ..video.video_file import VideoFile
from .take import Take

LONGEST_FRAMES = 40_000
"""Twenty minutes at 30 frames a second, for which an estimate needs about two and a half gigabytes."""


def open_clip(take: Take) -> Clip:
    """Open a take's clip and check `take.json` against it.

    Raises:
        InputError: The clip is missing or unreadable, or its size, its number of frames, the camera's
            poses or a keyframe do not fit.
    """
    clip = open_footage(take.clip, take.fps, take.camera.resolution)
    check_size(take, clip)
    count = clip.frame_count
    expected = {take.frame_count, *(len(people.frames) for people in take.keypoints)} - {None}
    if count > LONGEST_FRAMES or expected - {count}:
        # Containers may claim a wrong number; decoding counts.
        count = sum(1 for _ in islice(clip.source.time_stamps(), LONGEST_FRAMES + 1))
    check_frame_count(take, count)
    return clip


def open_footage(path: Path, fps: float | None, size: tuple[int, int] | None = None) -> Clip:
    """Open a clip without its take; `fps` is the rate of an image sequence, `size` as in `Clip.open`.

    Raises:
        InputError: The clip is missing, unreadable or too long.
    """
    try:
        clip = Clip.open(path, fps, size)
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error
    if clip.frame_count > LONGEST_FRAMES and _counted(clip) > LONGEST_FRAMES:  # headers may exaggerate
        raise _too_long(path, clip.fps)
    return clip


def picture_count(path: Path, fps: float) -> int:
    """Number of pictures of a clip without its take."""
    return _counted(open_footage(path, fps))


def _counted(clip: Clip) -> int:
    """Number of pictures up to one too many; of a sound file quickly, by its undecoded packets."""
    if not isinstance(clip.source, VideoFile):
        return clip.frame_count
    packets = None if clip.source.is_trimmed else read_packets(clip.path, LONGEST_FRAMES + 1)
    if packets is not None:
        return len(packets.time_s)
    return sum(1 for _ in islice(clip.source.time_stamps(), LONGEST_FRAMES + 1))


def _too_long(path: Path, fps: float) -> InputError:
    longest_s = LONGEST_FRAMES / fps
    return InputError(
        f"{path}: has more than {LONGEST_FRAMES} frames, {longest_s / 60.0:.0f} minutes; it must be shorter: "
        f"cut it, as with ffmpeg -ss 0 -t {int(longest_s)} -i CLIP part1.mp4"
    )


def check_size(take: Take, clip: Clip) -> None:
    """Check the size of a clip's frames against the camera's resolution."""
    stated = take.camera.resolution
    if clip.size == stated:
        return
    turned = (
        "; the camera was held the other way, or its file says that it is to be turned: swap the two, and "
        "give sensor_width_mm and the pose of the camera as it was held"
    )
    raise InputError(
        f"{take.file}: camera.resolution is {list(stated)}; the clip {take.clip.name} is {list(clip.size)}, "
        f"and they must be equal{turned if clip.size == stated[::-1] else ''}"
    )


def check_frame_count(take: Take, count: int, claimed: int = 0) -> None:
    """Check the true number of a clip's frames against the take.

    Raises:
        InputError: There are too many, `frame_count` or the number of frames with keypoints differs, or a
            keyframe or the camera's poses lie outside the clip.
    """
    path = take.file
    if count > LONGEST_FRAMES:
        raise _too_long(take.clip, take.fps)
    if take.frame_count not in (None, count):
        raise InputError(
            f"{path}: frame_count is {take.frame_count}; "
            f"{take.clip.name} holds {count} frames that can be decoded{_damage_hint(count, claimed)}"
        )
    if take.camera.is_moving and len(take.camera.matrix_world) < count:
        poses = len(take.camera.matrix_world)
        raise InputError(
            f"{path}: camera.matrix_world_frames has {poses} poses; {take.clip.name} has {count} frames, "
            "and each needs one"
        )
    for people in take.keypoints:
        if abs(len(people.frames) - count) > tolerance(count):
            raise InputError(
                f"{people.file or people.source}: has keypoints of {len(people.frames)} frames; "
                f"{take.clip.name} has {count}{_damage_hint(count, claimed)}; they must be those of this "
                "clip, frame by frame"
            )
    for keyframe in take.keyframes:
        if keyframe.index >= count:
            raise InputError(
                f"{take.clip}: keyframe {keyframe.index + take.frame_start} lies outside the clip, "
                f"whose frames are {take.frame_start} to {take.frame_start + count - 1}"
                f"{_damage_hint(count, claimed)}"
            )


def _damage_hint(count: int, claimed: int) -> str:
    if count >= claimed:
        return ""
    return f"; it claims {claimed}, so it may be cut off or damaged: copy it again from where it was recorded"


def check_in_front(take: Take) -> None:
    """Check that the camera sees the keyframes."""
    size = np.asarray(take.camera.resolution, dtype=np.float64)
    in_picture = not take.keyframes
    for keyframe in take.keyframes:
        points = take.body.points(take.body.pose(keyframe.posture))
        depth = take.camera.depth(points, keyframe.index)
        if depth.min() <= 0.0:
            name = take.body.skeleton.point_names[int(depth.argmin())]
            raise InputError(
                f"{take.file}: keyframe {keyframe.index + take.frame_start} has the point {name} "
                f"{-depth.min():.2f} m behind the camera; the camera's pose in take.json must look "
                "(along its local -Z) at the performer"
            )
        pixels, _ = take.camera.project(points, keyframe.index)
        in_picture = in_picture or bool(((pixels >= 0.0) & (pixels <= size)).all(axis=-1).any())
    if not in_picture:
        raise InputError(
            f"{take.file}: not one point of any keyframe lies in the camera's picture; the camera's pose, "
            "its lens and the keyframes, all in meters in one world, must fit each other"
        )


NOTICEABLE_RATE = 0.02
"""Difference of two frame rates that is worth a note, as a share of the take's."""
LONGEST_INTERVAL = 2.5
"""Time between two frames, as a multiple of the median, from which on frames seem to be missing."""
VARIABLE_RATE = "the clip has a variable frame rate: keys lie at the true times, between whole frames"


def clip_notes(take: Take, clip: Clip, reading: Reading) -> tuple[str, ...]:
    """Sentences on what may be wrong with a clip that has been read."""
    rate = rate_note(take, clip)
    notes = [*clip.notes] if rate is None else [*clip.notes, rate]
    tracks = reading.tracks
    trimmed = isinstance(clip.source, VideoFile) and clip.source.is_trimmed
    short = tracks.frame_count < clip.frame_count and not trimmed
    if short and tracks.time_s[-1] * clip.fps < clip.frame_count - 1.5:
        notes.append(
            f"{clip.path.name} claims {clip.frame_count} frames, of which {tracks.frame_count} can "
            "be decoded; it may be cut off or damaged"
        )
    notes += reading.frame_findings.notes(take.frame_start, clip.fps)
    intervals = np.diff(tracks.time_s)
    if len(intervals) > 1 and intervals.max() >= LONGEST_INTERVAL * np.median(intervals):
        before = int(intervals.argmax())  # from there on frame numbers are no longer times
        notes.append(
            f"{intervals[before]:.2f} s are missing after frame {before + take.frame_start}; check the "
            "keyframes after it"
        )
    return tuple(notes)


def rate_note(take: Take, clip: Clip) -> str | None:
    """A sentence where the clip's own frame rate differs from the take's; None where they agree."""
    if abs(clip.fps - take.fps) <= NOTICEABLE_RATE * take.fps:
        return None
    return (
        f"{take.file.name} says {take.fps:g} frames per second, {take.clip.name} says {clip.fps:g}; "
        "check that it is the take's own clip"
    )


FOLLOWING, READING = "Following the markers", "Reading the clip"
EXPECTED_RADIUS_M = 0.45
"""Radius around a marker of the interpolated keyframes within which it is searched first."""
RADIUS_GROWTH_M_PER_S = 3.0
"""Growth of that radius farther from a keyframe than ..."""
KNOWN_S = 0.2
"""... this: a limb may have swung there and back in between, and before the first keyframe and after the last
the posture is only held [s]."""


def read_footage(
    take: Take, kept: Reading | None = None, watch: Watch | None = None, stage: str = READING
) -> Job[Reading]:
    """Read a take's clip: tracks of its markers, notes, and an album where the camera stands still.

    `kept` and `watch` are as in `read_clip`; `stage` is shown meanwhile where no markers are followed.
    """
    yield Progress("Opening the clip", 0.0)
    clip = open_clip(take)
    check_in_front(take)
    expected = (
        expected_regions(take, take.frame_count or clip.frame_count) if len(take.keyframes) > 1 else None
    )
    # Before a camera that moves, no background stands still to tell the performer from.
    with_album = take.contours and not take.camera.is_moving
    job = read_clip(clip, take.markers, expected, with_album, kept, take.ignored_regions, watch)
    reading = yield from within(FOLLOWING if take.markers else stage, job, 0.0, 1.0)
    check_frame_count(take, reading.tracks.frame_count, clip.frame_count)
    return replace(reading, notes=clip_notes(take, clip, reading))


def expected_regions(take: Take, frame_count: int) -> ExpectedRegions:
    """Regions around each marker of the interpolated keyframes, with a generous radius."""
    prior = interpolate(take.keyframes, frame_count)
    model = average_model(take)
    center = np.empty((frame_count, len(take.markers), 2))
    for frame in chunks(np.arange(frame_count), 500):
        center[frame] = model.evaluate(take.body.pose(prior[frame]), frame).centroid
    depth = take.camera.depth(prior.translation, np.arange(frame_count))
    frame, posed = np.arange(frame_count), np.array(sorted(take.keyframe_indices))
    away = np.abs(frame[:, None] - posed).min(axis=1) / take.fps
    reach = EXPECTED_RADIUS_M + RADIUS_GROWTH_M_PER_S * np.maximum(away - KNOWN_S, 0.0)
    radius = reach * take.camera.pixels_per_meter(depth)
    # To a fraction of a pixel, so that a posture read from Blender once more expects the same.
    center, radius = np.round(64.0 * center) / 64.0, np.round(64.0 * radius) / 64.0
    return ExpectedRegions(center, np.repeat(radius[:, None], len(take.markers), axis=1))


def average_model(take: Take) -> RegionModel:
    """The markers as worn by an average performer."""
    placements = tuple(MarkerPlacement.usual(segment) for segment in take.marker_segments)
    return RegionModel(take.body, take.camera, placements)
