"""A take: one recorded performance on disk, read with every field checked, and written."""

import os
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..body.actor import Actor
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..errors import InputError
from ..files.control_characters import is_hidden
from ..files.fields import Fields, listed
from ..files.inherited_fields import Inherited
from ..files.json_file import shown, write_json, write_whole
from ..footage.camera import Camera
from ..footage.clips.clip import Clip
from ..footage.marker_style import MarkerStyle
from ..prior.keyframes import Keyframe
from .description import OWN, Description, describe
from .keyframe_file import FEWEST_KEYFRAMES, read_keyframes, write_keyframes

TRUNK = "trunk"
"""Not one segment of the skeleton but all between hips and shoulders: a marker may be bound to it."""
MARKER_SEGMENTS = (TRUNK, *(segment.name for segment in HUMAN.segments))
MOST_FRAMES = 10**6
LONGEST_FRAMES = 40_000
"""Of one take: twenty minutes at 30 a second, for which an estimate needs about two and a half gigabytes."""
MOST_MARKERS = 64
LONGEST_MARKER = 200
"""Characters of a marker's name."""
POORLY_FITTED_M = 0.06
"""Hand-posed points fit an actor of the right size within two or three centimeters."""
NOTICEABLE_RATE = 0.02


@dataclass(frozen=True, eq=False)
class Take:
    """One recorded performance, validated."""

    folder: Path
    clip: Path
    """The footage: a video, a folder of images, or a pattern of numbered images."""
    fps: float
    frame_start: int
    """Scene frame of the clip's first decoded frame."""
    frame_count: int | None
    """Frames of the clip; None where only the clip itself tells."""
    camera: Camera
    body: Body
    markers: tuple[MarkerStyle, ...]
    keyframes: tuple[Keyframe, ...]
    described_in: Path | None = None
    """The file that sentences name; None for a folder's own `take.json`."""
    title: str = ""
    """What people call it; empty for the folder's name."""

    @property
    def file(self) -> Path:
        """The file that describes it."""
        return self.described_in or self.folder / OWN

    @property
    def name(self) -> str:
        """What people call it."""
        return self.title or self.folder.absolute().name

    @property
    def marker_segments(self) -> tuple[str, ...]:
        """The segment each marker is bound to."""
        return tuple(style.segment for style in self.markers)

    @property
    def keyframe_indices(self) -> tuple[int, ...]:
        """Positions of the keyframes in the clip."""
        return tuple(keyframe.index for keyframe in self.keyframes)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is usable but looks wrong, one sentence each."""
        return tuple(
            f"keyframe {keyframe.index + self.frame_start}: its points are {100 * keyframe.residual_m:.0f} "
            "cm on average from any posture of this actor; check them and the actor's segment lengths"
            for keyframe in self.keyframes
            if keyframe.residual_m > POORLY_FITTED_M
        )


def read_take(
    place: Path,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
) -> Take:
    """Read a take and what it inherits from the shoots above; the clip is not checked yet (see `open_clip`).

    Args:
        place: The folder that holds `take.json`, or a clip that a shoot describes (see `shoot/description`).
        keyframes: The keyframe file; by default the take's own, usually `keyframes.json` in the folder.
        keyframes_required: Whether a take without a keyframe file is refused.

    Raises:
        InputError: A file or field is missing or unusable; the sentence names it and what would be valid.
    """
    return read_described(describe(place), keyframes, keyframes_required=keyframes_required)


def read_described(
    description: Description,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
    fewest_keyframes: int = FEWEST_KEYFRAMES,
) -> Take:
    """Read a take as it is described; see `read_take`.

    `fewest_keyframes` says how many the keyframe file must hold; with 0 the take's own is not even opened.
    """
    fields = description.fields
    if description.inherits:
        fields = _with_the_clip(fields, description.clip)
    from_clip = description.inherits and not fields.has("frame_start")
    frame_start = 1 if from_clip else fields.whole("frame_start", -(10**6), 10**6)
    frame_count = fields.whole("frame_count", 2, MOST_FRAMES) if fields.has("frame_count") else None
    body = _body(fields)
    camera = _camera(fields, frame_count)
    posed = keyframes or description.keyframes
    optional = keyframes is None and not keyframes_required
    missing = optional and (fewest_keyframes == 0 or not os.path.exists(posed))
    if not missing and keyframes is None and not os.path.exists(posed):
        raise InputError(
            f"{posed}: no such file; a take needs keyframes posed there, or a keyframe library to match, as "
            'in "library": "auto"'
        )
    return Take(
        folder=description.folder,
        clip=description.clip,
        fps=fields.number("fps", 1.0, 1000.0, "frames per second"),
        frame_start=frame_start,
        frame_count=frame_count,
        camera=camera,
        body=body,
        markers=_markers(fields),
        keyframes=() if missing else read_keyframes(posed, body, frame_start, frame_count, fewest_keyframes),
        described_in=description.file,
        title=description.name,
    )


def open_clip(take: Take) -> Clip:
    """Open a take's clip and check what `take.json` says of it.

    Raises:
        InputError: The clip is missing or unreadable, or its size, its number of frames, the camera's
            poses or a keyframe do not fit.
    """
    clip = opened(take.clip, take.fps)
    check_size(take, clip)
    count = clip.frame_count
    if count > LONGEST_FRAMES or take.frame_count not in (None, count):
        # Containers may claim a wrong number; decoding tells.
        count = sum(1 for _ in islice(clip.source.time_stamps(), LONGEST_FRAMES + 1))
    check_frame_count(take, count)
    return clip


def check_size(take: Take, clip: Clip) -> None:
    """Hold the size of a clip's frames against the take.

    Raises:
        InputError: The camera's resolution is another.
    """
    if clip.size != take.camera.resolution:
        raise InputError(
            f"{take.file}: camera.resolution is {list(take.camera.resolution)}; "
            f"the clip {take.clip.name} is {list(clip.size)}, and they must be equal"
            f"{_turned(take, clip)}"
        )


def opened(path: Path, fps: float | None) -> Clip:
    """Open a clip, of whatever take; `fps` is the rate of images.

    Raises:
        InputError: It is missing or unreadable.
    """
    try:
        return Clip.open(path, fps=fps)
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error


def _turned(take: Take, clip: Clip) -> str:
    """What to do where width and height are swapped."""
    if clip.size != take.camera.resolution[::-1]:
        return ""
    return (
        "; the camera was held the other way, or its file says that it is to be turned: swap the two, and "
        "give sensor_width_mm and the pose of the camera as it was held"
    )


def check_frame_count(take: Take, count: int, claimed: int = 0) -> None:
    """Hold the number of frames that a clip really has against the take.

    Args:
        take: The take.
        count: The frames that there are.
        claimed: Those that the clip's file says there are.

    Raises:
        InputError: There are too many, `frame_count` differs, or a keyframe or the camera's poses lie outside
            the clip.
    """
    path = take.file
    if count > LONGEST_FRAMES:
        raise InputError(
            f"{take.clip}: has more than {LONGEST_FRAMES} frames, {LONGEST_FRAMES / take.fps / 60.0:.0f} "
            "minutes; a take must be shorter: cut it, as with ffmpeg -ss 0 -t 600 -i CLIP part1.mp4"
        )
    if take.frame_count not in (None, count):
        raise InputError(
            f"{path}: frame_count is {take.frame_count}; "
            f"{take.clip.name} holds {count} frames that can be decoded{_cut_off(count, claimed)}"
        )
    if take.camera.is_moving and len(take.camera.matrix_world) < count:
        poses = len(take.camera.matrix_world)
        raise InputError(
            f"{path}: camera.matrix_world_frames has {poses} poses; {take.clip.name} has {count} frames, "
            "and each needs one"
        )
    for keyframe in take.keyframes:
        if keyframe.index >= count:
            raise InputError(
                f"{take.clip}: keyframe {keyframe.index + take.frame_start} lies outside the clip, "
                f"whose frames are {take.frame_start} to {take.frame_start + count - 1}"
                f"{_cut_off(count, claimed)}"
            )


def _cut_off(count: int, claimed: int) -> str:
    """What may be the matter where a file claims more frames than there are."""
    if count >= claimed:
        return ""
    return f"; it claims {claimed}, so it may be cut off or damaged: copy it again from where it was recorded"


def check_in_front(take: Take) -> None:
    """Hold the keyframes against the camera: what lies behind it can leave nothing in its picture.

    Raises:
        InputError: A point of a keyframe lies behind the camera, or no point of any is in its picture.
    """
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


def rate_note(take: Take, clip: Clip) -> str | None:
    """A sentence where the clip's own frame rate is not the take's; None where they agree."""
    if abs(clip.fps - take.fps) <= NOTICEABLE_RATE * take.fps:
        return None
    return f"{take.file.name} says {take.fps:g} frames per second, {take.clip.name} says {clip.fps:g}"


def write_take(take: Take, folder: Path) -> None:
    """Write a take that `read_take` reads back: `take.json`, `keyframes.json` and the clip.

    Every file is written beside and moved into place; a clip that lies in the folder stays as it is.

    Raises:
        InputError: The clip is a pattern of images outside the folder, which cannot be copied as one.
        ConversionError: A file cannot be written.
    """
    clip = _clip_inside(take, folder)
    fields: dict[str, Any] = {"fps": take.fps, "frame_start": take.frame_start}
    if take.frame_count is not None:
        fields["frame_count"] = take.frame_count
    fields["clip"] = clip
    fields["camera"] = take.camera.to_dict()
    fields["markers"] = {
        style.name: {"segment": style.segment, "color_srgb": list(style.color_srgb)} for style in take.markers
    }
    fields["actor"] = {"segments_m": dict(take.body.actor.segments_m)}
    if take.keyframes:
        write_keyframes(folder / "keyframes.json", take.keyframes, take.body, take.frame_start)
    write_json(folder / "take.json", fields, indent=1)


def _clip_inside(take: Take, folder: Path) -> str:
    """The clip's path within `folder`, after copying it there where it lies elsewhere."""
    source = take.clip.resolve()
    if source.is_relative_to(folder.resolve()):
        return source.relative_to(folder.resolve()).as_posix()
    if not source.exists():
        raise InputError(
            f"{take.clip}: no such file or folder; only a video or a folder of images can be copied"
        )
    copy = shutil.copytree if source.is_dir() else shutil.copyfile
    write_whole(folder / source.name, lambda beside: copy(source, beside))
    return source.name


def _with_the_clip(fields: Fields, path: Path) -> Fields:
    """The fields with rate and size from the clip itself, where the shoot leaves them out."""
    assert isinstance(fields.values, Inherited)
    camera = fields.values.get("camera")
    sized = not isinstance(camera, Mapping) or camera.get("resolution") is not None
    if fields.has("fps") and sized:
        return fields
    clip = opened(path, None)
    told: dict[str, Any] = {}
    if not fields.has("fps") and clip.knows_its_rate:
        told["fps"] = clip.fps
    if not sized:
        told["camera"] = {"resolution": list(clip.size)}
    return Fields(fields.values.patched(told, str(path)), fields.where)


def _camera(fields: Fields, frame_count: int | None) -> Camera:
    child = fields.child("camera", "an object with lens_mm, sensor_width_mm, resolution and matrix_world")
    camera = Camera.from_dict(child.values, child.where)
    if camera.is_moving and frame_count is not None and len(camera.matrix_world) < frame_count:
        raise InputError(
            f"{child.where}: matrix_world_frames has {len(camera.matrix_world)} poses; "
            f"it must have one for each of the {frame_count} frames"
        )
    return camera


def _body(fields: Fields) -> Body:
    actor = fields.child("actor", "an object with segments_m, or with height_m alone")
    height_m = actor.number("height_m", 0.5, 3.0, "m") if actor.has("height_m") else None
    if height_m is not None and not actor.has("segments_m"):
        return Body(Actor.from_stature(height_m))
    lengths: Mapping[str, Any] = actor.child("segments_m", "an object of lengths in meters").values
    try:
        return Body(Actor(lengths))
    except InputError as error:
        raise InputError(f"{fields.at('actor')}: {error}") from error


def _markers(fields: Fields) -> tuple[MarkerStyle, ...]:
    markers = fields.child("markers", "an object of markers by name, each with color_srgb")
    if not markers.values:
        raise InputError(f"{markers.where} is empty; at least one marker is needed, better five")
    if len(markers.values) > MOST_MARKERS:
        raise InputError(
            f"{markers.where} has {len(markers.values)} markers; at most {MOST_MARKERS} are read"
        )
    styles = tuple(_marker(markers, name) for name in markers.values)
    seen: dict[tuple[int, int, int], str] = {}
    for style in styles:
        twin = seen.setdefault(style.color_srgb, style.name)
        if twin != style.name:
            raise InputError(
                f"{markers.where}: {shown(twin)} and {shown(style.name)} have the same color_srgb "
                f"{list(style.color_srgb)}; each marker needs a color of its own"
            )
    return styles


def _marker(markers: Fields, name: str) -> MarkerStyle:
    if not name.strip() or len(name) > LONGEST_MARKER or any(map(is_hidden, name)):
        raise InputError(
            f"{markers.where}: a marker is called {shown(name)}; its name must be one line of at most "
            f"{LONGEST_MARKER} characters that can be seen"
        )
    marker = markers.child(name, "an object with color_srgb")
    segment = marker.text("segment", "a body segment's name") if marker.has("segment") else name
    if segment not in MARKER_SEGMENTS:
        raise InputError(
            f"{markers.where}: {shown(name)} is bound to the unknown segment {shown(segment)}; "
            f"known are {listed(MARKER_SEGMENTS)}"
        )
    color = marker.numbers("color_srgb", 3, 0.0, 255.0, "three numbers from 0 to 255, as an eyedropper gives")
    red, green, blue = (round(value) for value in color)
    return MarkerStyle(name=name, segment=segment, color_srgb=(red, green, blue))
