"""`take.json`: reading a take with every field checked, and writing one."""

import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..body.actor import Actor
from ..body.body_volume import TRUNK
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..errors import InputError
from ..files.control_characters import is_control_character
from ..files.fields import Fields, listed
from ..files.inherited_fields import InheritedFields
from ..files.json_file import shown, write_atomically, write_json
from ..footage.camera import Camera
from ..footage.marker_style import MarkerStyle
from .clip_check import open_footage
from .description import Description, describe
from .keyframe_file import FEWEST_KEYFRAMES, read_keyframes, write_keyframes
from .take import Take

MARKER_SEGMENTS = (TRUNK, *(segment.name for segment in HUMAN.segments))
"""What a marker may be bound to: a segment of the skeleton, or all between hips and shoulders."""
MOST_FRAMES = 10**6
MOST_MARKERS = 64
LONGEST_MARKER_NAME = 200
"""Characters."""


def read_take(
    path: Path,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
) -> Take:
    """Read a take with its inherited fields; the clip is not checked yet (see `clip_check`).

    Args:
        path: The folder that holds `take.json`, or a clip that a shoot describes (see `description`).
        keyframes: The keyframe file; by default the take's own, usually `keyframes.json` in the folder.
        keyframes_required: Whether a take without a keyframe file is refused.

    Raises:
        InputError: A file or field is missing or unusable; the sentence names it and what would be valid.
    """
    return read_described(describe(path), keyframes, keyframes_required=keyframes_required)


def read_described(
    description: Description,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
    fewest_keyframes: int = FEWEST_KEYFRAMES,
) -> Take:
    """Read a take from its description; see `read_take`.

    `fewest_keyframes` is the number that the keyframe file must hold; with 0 the take's own is not opened.
    """
    fields = description.fields
    if description.inherits:
        fields = _with_clip_fields(fields, description.clip)
    from_clip = description.inherits and not fields.has("frame_start")
    frame_start = 1 if from_clip else fields.integer("frame_start", -(10**6), 10**6)
    frame_count = fields.integer("frame_count", 2, MOST_FRAMES) if fields.has("frame_count") else None
    body = _body(fields)
    camera = _camera(fields, frame_count)
    posed = keyframes or description.keyframes
    optional = keyframes is None and not keyframes_required
    missing = optional and (fewest_keyframes == 0 or not os.path.exists(posed))
    if not missing and keyframes is None and not os.path.exists(posed):
        named = f" ({fields.source_of('keyframes')} names it)" if fields.has("keyframes") else ""
        raise InputError(
            f"{posed}: no such file{named}; a take needs keyframes posed there, or a keyframe library to "
            'match, as in "library": "auto"'
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


def write_take(take: Take, folder: Path) -> None:
    """Write a take that `read_take` reads back: `take.json`, `keyframes.json` and the clip.

    Every file is written atomically; a clip that lies in the folder stays as it is.

    Raises:
        InputError: The clip is a pattern of images outside the folder, which cannot be copied as one.
        ConversionError: A file cannot be written.
    """
    clip = _copy_clip(take, folder)
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


def _copy_clip(take: Take, folder: Path) -> str:
    """Copy the clip into `folder` unless it lies there; returns its path within."""
    source = take.clip.resolve()
    if source.is_relative_to(folder.resolve()):
        return source.relative_to(folder.resolve()).as_posix()
    if not source.exists():
        raise InputError(
            f"{take.clip}: no such file or folder; only a video or a folder of images can be copied"
        )
    copy = shutil.copytree if source.is_dir() else shutil.copyfile
    write_atomically(folder / source.name, lambda beside: copy(source, beside))
    return source.name


def _with_clip_fields(fields: Fields, path: Path) -> Fields:
    """The fields with rate and size from the clip itself, where all files leave them out."""
    assert isinstance(fields.values, InheritedFields)
    camera = fields.values.get("camera")
    sized = not isinstance(camera, Mapping) or camera.get("resolution") is not None
    if fields.has("fps") and sized:
        return fields
    clip = open_footage(path, None)
    from_clip: dict[str, Any] = {}
    if not fields.has("fps") and clip.knows_its_rate:
        from_clip["fps"] = clip.fps
    if not sized:
        from_clip["camera"] = {"resolution": list(clip.size)}
    merged = fields.values.overridden_by(from_clip, str(path))
    if (
        not sized
    ):  # the clip gives the size alone: what else the camera lacks is missing where it is described
        merged.sources["camera"] = fields.source_of("camera")
    return Fields(merged, fields.where)


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
        raise InputError(f"{fields.source_of('actor')}: {error}") from error


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
    if not name.strip() or len(name) > LONGEST_MARKER_NAME or any(map(is_control_character, name)):
        raise InputError(
            f"{markers.where}: a marker is called {shown(name)}; its name must be one line of at most "
            f"{LONGEST_MARKER_NAME} visible characters"
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
