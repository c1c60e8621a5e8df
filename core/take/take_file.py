"""`take.json`: reading a take with every field checked, and writing one."""

import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from itertools import islice
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
from ..footage.ignored_region_fields import IGNORED_REGIONS, ignored_region_fields, read_ignored_regions
from ..footage.keypoints.keypoint_file import read_keypoints, write_keypoints
from ..footage.keypoints.people import People
from ..footage.marker_style import MarkerStyle
from .clip_check import open_footage, picture_count
from .conversion_settings import ConversionSettings
from .description import KEYPOINT_FILE, Description, describe, keypoint_files
from .evidence import check_evidence, with_evidence
from .keyframe_file import FEWEST_KEYFRAMES, read_keyframes, write_keyframes
from .take import Take

MARKER_SEGMENTS = (TRUNK, *(segment.name for segment in HUMAN.segments))
"""What a marker may be bound to: a segment of the skeleton, or all between hips and shoulders."""
MOST_FRAMES = 10**6
MOST_MARKERS = 64
LONGEST_MARKER_NAME = 200
"""Characters."""
MISTYPED = 0.85
"""Likeness of an object's name from which on it is `markers` with one letter wrong."""


def read_take(
    path: Path,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
    whole: bool = False,
) -> Take:
    """Read a take with its inherited fields; the clip is not checked yet (see `clip_check`).

    Args:
        path: The folder that holds `take.json`, or a clip that a shoot describes (see `description`).
        keyframes: The keyframe file; by default the take's own, usually `keyframes.json` in the folder.
        keyframes_required: Whether a take without a keyframe file is refused.
        whole: Whether evidence that its description leaves aside is read too, and none at all is accepted.

    Raises:
        InputError: A file or field is missing or unusable; the sentence names it and what would be valid.
    """
    return read_described(describe(path), keyframes, keyframes_required=keyframes_required, whole=whole)


def read_described(
    description: Description,
    keyframes: Path | None = None,
    *,
    keyframes_required: bool = True,
    fewest_keyframes: int = FEWEST_KEYFRAMES,
    settings: ConversionSettings | None = None,
    whole: bool = False,
) -> Take:
    """Read a take from its description; see `read_take`.

    Args:
        description: The description.
        keyframes: As for `read_take`.
        keyframes_required: As for `read_take`.
        fewest_keyframes: Number that the keyframe file must hold; with 0 the take's own is not opened.
        settings: Those that say which keypoints are read and which evidence is used; by default the take's.
        whole: As for `read_take`.
    """
    fields = description.fields
    settings = settings or description.settings
    settings = replace(settings, evidence=None) if whole else settings
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
            f"{posed}: no such file{named}; a take needs keyframes posed there, or found in its footage: "
            '--keyframes auto, or "keyframes": "auto" in its description'
        )
    fps = fields.number("fps", 1.0, 1000.0, "frames per second")
    take = Take(
        folder=description.folder,
        clip=description.clip,
        fps=fps,
        frame_start=frame_start,
        frame_count=frame_count,
        camera=camera,
        body=body,
        markers=_markers(fields),
        keyframes=() if missing else read_keyframes(posed, body, frame_start, frame_count, fewest_keyframes),
        described_in=description.file,
        title=description.name,
        keypoints=_keypoints(description, settings, camera, fps, frame_start, frame_count),
        ignored_regions=read_ignored_regions(fields, camera.resolution, frame_start),
    )
    if whole:
        return take
    check_evidence(take, settings.evidence, _source_of_evidence(description, settings))
    return take if settings.evidence is None else with_evidence(take, settings.evidence)


def _keypoints(
    description: Description,
    settings: ConversionSettings,
    camera: Camera,
    fps: float,
    frame_start: int,
    frame_count: int | None,
) -> tuple[People, ...]:
    files = keypoint_files(description, settings)
    if not files:
        return ()
    if frame_count is None:  # detectors that number their files need not write one for every frame
        frame_count = _counted(description, fps)
    return tuple(read_keypoints(file, frame_count, camera.resolution, fps, frame_start) for file in files)


def _counted(description: Description, fps: float) -> int:
    """Number of pictures of the clip of a take that does not say it."""
    try:
        return picture_count(description.clip, fps)
    except InputError as error:
        where = description.fields.source_of("frame_count")
        raise InputError(f"{where}: frame_count is not given, and {error}") from error


def _source_of_evidence(description: Description, settings: ConversionSettings) -> str:
    said = settings.evidence == description.settings.evidence
    return description.fields.source_of("evidence") if said else str(description.path)


def write_take(take: Take, folder: Path, evidence: Sequence[str] | None = None) -> None:
    """Write a take that `read_take` reads back: `take.json`, `keyframes.json`, keypoints and the clip.

    Every file is written atomically; a clip or keypoints that lie in the folder stay as they are.

    Args:
        take: The take.
        folder: The folder, new or old.
        evidence: The kinds of evidence that it is to be held against; None for whatever it has.

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
    if take.markers:
        fields["markers"] = {
            style.name: {"segment": style.segment, "color_srgb": list(style.color_srgb)}
            for style in take.markers
        }
    if take.ignored_regions:
        fields[IGNORED_REGIONS] = ignored_region_fields(take.ignored_regions, take.frame_start)
    if take.keypoints:
        fields["keypoints"] = _write_keypoints(take, folder)
    if evidence is not None:
        fields["evidence"] = list(evidence)
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


def _write_keypoints(take: Take, folder: Path) -> list[str]:
    """Write keypoints into `folder`, but for those that lie there; returns their paths within."""
    names = [_name_within(people, folder) for people in take.keypoints]
    ending, number = Path(KEYPOINT_FILE), 1
    for index, people in enumerate(take.keypoints):
        if names[index]:
            continue
        name = ending.name
        while name in names:
            number += 1
            name = f"{ending.stem}{number}{ending.suffix}"
        write_keypoints(folder / name, people, take.frame_start, take.fps)
        names[index] = name
    return names


def _name_within(people: People, folder: Path) -> str:
    """The path in `folder` of the file that keypoints were read from; empty where it lies elsewhere."""
    source, within = Path(people.file).resolve(), folder.resolve()
    there = people.file and source.exists() and source.is_relative_to(within)
    return source.relative_to(within).as_posix() if there else ""


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
    """The markers; none where the field is absent or empty, as of a performer in any clothes."""
    valid = "an object of markers by name, each with color_srgb"
    mistyped = get_close_matches("markers", _names_of_objects(fields), n=1, cutoff=MISTYPED)
    if not fields.has("markers") and not mistyped:
        return ()
    markers = fields.child("markers", valid)
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


def _names_of_objects(fields: Fields) -> list[str]:
    return [name for name, value in islice(fields.values.items(), 100) if isinstance(value, Mapping)]


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
