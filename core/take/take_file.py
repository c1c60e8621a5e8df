"""`take.json`: reading a take with every field checked, and writing one."""

import os
import shutil
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from difflib import get_close_matches
from itertools import islice
from pathlib import Path
from typing import Annotated, Any

from .. import FRAME_STARTS, MOST_FRAMES
from ..body.actor import Actor, Segments
from ..body.body_volume import MARKER_SEGMENTS
from ..body.kinematics import Body
from ..camera.camera import Camera
from ..camera.camera_fields import CameraFields
from ..detect.keypoint_file import read_keypoints, write_keypoints
from ..detect.keypoints import People
from ..errors import InputError, shown
from ..files.fields import Fields, InheritedFields, child_location, listed
from ..files.json_file import write_atomically, write_json
from ..files.kinds import ByName, Choice, Items, Kind, Number, Text, Whole, refuse
from ..files.records import Object, Record, read_record
from ..markers.ignored_regions import (
    IGNORED_REGIONS,
    MOST_REGIONS,
    IgnoredRegion,
    ignored_region_fields,
    ignored_regions,
)
from ..markers.region_tracks import MarkerStyle
from .conversion_settings import ConversionSettings
from .description import KEYPOINT_FILE, Description, describe, keypoint_files
from .evidence import MOST_MARKERS
from .keyframe_file import FEWEST_KEYFRAMES, read_keyframes, write_keyframes
from .read_footage import open_footage, picture_count
from .reference import ReadArmature, reference_of_take
from .take import Take, check_evidence, with_evidence

LONGEST_MARKER_NAME = 200
MARKER_NAME = Text(
    LONGEST_MARKER_NAME, f"one line of at most {LONGEST_MARKER_NAME} visible characters", one_line=True
)


SHORTEST_M, TALLEST_M = 0.5, 3.0
"""Of a performer."""
USUAL_HEIGHT_M = 1.75
"""Of a performer whose height nobody says."""
FRAME_RATE = Number(1.0, 1000.0, "frames per second")
FRAME_START = Whole(*FRAME_STARTS)


def check_height(height_m: float, name: str) -> None:
    """Refuse what is no performer's height, as one in centimeters; `name` is what people call it."""
    if SHORTEST_M <= height_m <= TALLEST_M:
        return
    in_cm = SHORTEST_M <= height_m / 100.0 <= TALLEST_M
    hint = f"; {height_m:g} centimeters are {height_m / 100.0:g}" if in_cm else ", as in 1.78"
    raise InputError(f"{name} is {height_m:g}; meters from {SHORTEST_M:g} to {TALLEST_M:g} are valid{hint}")


class CameraKind(Kind):
    """A camera."""

    like = Object(CameraFields)
    valid = "an object with lens_mm, sensor_width_mm, resolution and matrix_world"

    def read(self, value: Any, where: str, name: str) -> Camera:
        """See `Kind`."""
        if not isinstance(value, Mapping):
            refuse(where, name, value, self.valid)
        return Camera.from_dict(value, child_location(where, name))


@dataclass(frozen=True)
class MarkerFields(Record):
    """A colored surface marker."""

    color_srgb: Annotated[
        tuple[Annotated[float, Number(0.0, 255.0)], ...],
        Items("numbers", 3, 3, "three numbers from 0 to 255, as an eyedropper gives"),
    ]
    """One eyedropper sample of the marker in the footage: red, green, blue."""
    segment: Annotated[str, Choice(MARKER_SEGMENTS)] | None = None
    """The body segment that the marker is bound to; the default is the segment of the marker's name."""


@dataclass(frozen=True, eq=False)
class ActorFields(Record):
    """The performer's size.

    Of segments_m and height_m the one in the nearer file counts; in the same file, segments_m.
    """

    height_m: Annotated[float, Number(SHORTEST_M, TALLEST_M, "m")] | None = None
    """Height [m], for a body of average proportions."""
    segments_m: Segments | None = None
    """Lengths of the segments [m]: joint to joint; shoulder_width and hip_width join the two joints' centers,
    trunk runs from between the hips to between the shoulders, neck_head from there to the middle of the
    head."""

    def mistake(self) -> str:
        """See `Record`."""
        if self.height_m is not None or self.segments_m is not None:
            return ""
        return "segments_m is missing; it must be an object of lengths in meters, or height_m"

    @property
    def body(self) -> Body:
        """The performer's body."""
        if self.segments_m is None:
            assert self.height_m is not None
            return Body(Actor.from_stature(self.height_m))
        return Body(Actor(self.segments_m))


@dataclass(frozen=True, eq=False)
class TakeFields(Record):
    """The fields of a take that say what it shows."""

    fps: Annotated[float, FRAME_RATE]
    """Frames per second. Below a shoot.json the default is the video's own."""
    frame_start: Annotated[int, FRAME_START]
    """Scene frame of the clip's first frame. Below a shoot.json the default is 1."""
    camera: Annotated[Camera, CameraKind()]
    """The camera that saw the performance."""
    actor: ActorFields
    """The performer's size."""
    markers: (
        Annotated[Mapping[str, MarkerFields], ByName("markers", MOST_MARKERS, key=MARKER_NAME)] | None
    ) = None
    """The performer's colored markers, by name; none where any clothes are worn."""
    ignored_regions: Annotated[tuple[IgnoredRegion, ...], Items("regions", 0, MOST_REGIONS)] | None = None
    """Regions of the picture that are never a marker, as a wall panel of a marker's color: boxes and strokes
    of a brush, in pixels of the footage from its top left corner, in all frames or some."""
    frame_count: Annotated[int, Whole(2, MOST_FRAMES)] | None = None
    """Number of frames of the clip; the default is the clip's own."""


def read_take(
    path: Path, keyframes: Path | None = None, *, keyframes_required: bool = True, whole: bool = False
) -> Take:
    """Read a take with its inherited fields; the clip is not checked yet (see `read_footage.py`).

    `keyframes` is by default the take's own file. `whole`: evidence that its description leaves aside is read
    too, and none at all is accepted.
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
    read_armature: ReadArmature | None = None,
) -> Take:
    """Read a take from its description; see `read_take`.

    `read_armature` reads a reference motion that only Blender can; it is left out without it.

    `fewest_keyframes` must be in the keyframe file; with 0 the take's own is not opened. `settings` say which
    keypoints are read and which evidence is used, by default the take's own.
    """
    fields = description.fields
    settings = settings or description.settings
    settings = replace(settings, evidence=None) if whole else settings
    if description.inherits:
        fields = _with_clip_fields(fields, description.clip)
    # Without markers a take has other evidence: a mistyped name of theirs must not lead there.
    objects = [name for name, value in islice(fields.values.items(), 100) if isinstance(value, Mapping)]
    if not fields.has("markers") and get_close_matches("markers", objects, n=1, cutoff=0.85):
        fields.required("markers", "an object of markers by name, each with color_srgb")
    record = read_record(TakeFields, fields)
    fps, frame_start, frame_count, camera = record.fps, record.frame_start, record.frame_count, record.camera
    if camera.is_moving and frame_count is not None and len(camera.matrix_world) < frame_count:
        raise InputError(
            f"{child_location(fields.source_of('camera'), 'camera')}: matrix_world_frames has "
            f"{len(camera.matrix_world)} poses; it must have one for each of the {frame_count} frames"
        )
    body = record.actor.body
    posed = keyframes or description.keyframes
    referred = settings.reference is not None  # it has keyframes of its own
    optional = keyframes is None and (referred or not keyframes_required)
    missing = optional and (fewest_keyframes == 0 or not os.path.exists(posed))
    if not missing and keyframes is None and not os.path.exists(posed):
        named = f" ({fields.source_of('keyframes')} names it)" if fields.has("keyframes") else ""
        raise InputError(
            f"{posed}: no such file{named}; a take needs keyframes posed there, or found in its footage: "
            '--keyframes auto, or "keyframes": "auto" in its description'
        )
    take = Take(
        folder=description.folder,
        clip=description.clip,
        fps=fps,
        frame_start=frame_start,
        frame_count=frame_count,
        camera=camera,
        body=body,
        markers=_markers(record.markers or {}, child_location(fields.source_of("markers"), "markers")),
        keyframes=() if missing else read_keyframes(posed, body, frame_start, frame_count, fewest_keyframes),
        described_in=description.file,
        title=description.name,
        keypoints=_keypoints(description, settings, camera, fps, frame_start, frame_count),
        reference=reference_of_take(settings.reference, settings.subject, read_armature),
        ignored_regions=ignored_regions(
            record.ignored_regions or (), camera.resolution, frame_start, fields.source_of(IGNORED_REGIONS)
        ),
    )
    if whole:
        return take
    own = settings.evidence == description.settings.evidence
    check_evidence(take, settings.evidence, fields.source_of("evidence") if own else str(description.path))
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
    size = stored = camera.resolution
    with suppress(InputError):
        stored = open_footage(description.clip, fps, size).stored_size
    if frame_count is None:  # detectors that number their files need not write one for every frame
        try:
            frame_count = picture_count(description.clip, fps)
        except InputError as error:
            where = description.fields.source_of("frame_count")
            raise InputError(f"{where}: frame_count is not given, and {error}") from error
    return tuple(read_keypoints(file, frame_count, size, fps, frame_start, stored) for file in files)


NOTHING_MORE: Mapping[str, Any] = {}


def write_take(
    take: Take,
    folder: Path,
    evidence: Sequence[str] | None = None,
    more: Mapping[str, Any] = NOTHING_MORE,
) -> None:
    """Write a take that `read_take` reads back: `take.json`, `keyframes.json`, keypoints and the clip.

    Every file is written atomically; a clip or keypoints that lie in the folder stay as they are. `more`
    are fields that a take does not hold.
    """
    clip = _copied(take.clip, folder)
    fields: dict[str, Any] = {**more, "fps": take.fps, "frame_start": take.frame_start}
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
    if take.reference is not None and take.reference.file:
        fields["reference"] = _copied(Path(take.reference.file), folder)
    if evidence is not None:
        fields["evidence"] = list(evidence)
    fields["actor"] = {"segments_m": dict(take.body.actor.segments_m)}
    if take.keyframes:
        write_keyframes(folder / "keyframes.json", take.keyframes, take.body, take.frame_start)
    write_json(folder / "take.json", fields, indent=1)


def _copied(original: Path, folder: Path) -> str:
    """Copy a clip or a motion into `folder` unless it lies there; returns its path within."""
    source = original.resolve()
    if source.is_relative_to(folder.resolve()):
        return source.relative_to(folder.resolve()).as_posix()
    if not source.exists():
        raise InputError(f"{original}: no such file or folder; only what is there can be copied")
    copy = shutil.copytree if source.is_dir() else shutil.copyfile
    write_atomically(folder / source.name, lambda beside: copy(source, beside))
    return source.name


def _write_keypoints(take: Take, folder: Path) -> list[str]:
    names, within = [""] * len(take.keypoints), folder.resolve()
    for index, people in enumerate(take.keypoints):  # of files that lie there already
        source = Path(people.file).resolve()
        if people.file and source.exists() and source.is_relative_to(within):
            names[index] = source.relative_to(within).as_posix()
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


def _with_clip_fields(fields: Fields, path: Path) -> Fields:
    """The fields with rate and size from the clip itself, where all files leave them out."""
    assert isinstance(fields.values, InheritedFields)
    camera = fields.values.get("camera")
    sized = not isinstance(camera, Mapping) or camera.get("resolution") is not None
    if fields.has("fps") and fields.has("frame_start") and sized:
        return fields
    from_clip: dict[str, Any] = {} if fields.has("frame_start") else {"frame_start": 1}
    if not fields.has("fps") or not sized:
        clip = open_footage(path, None)
    if not fields.has("fps") and clip.knows_its_rate:
        from_clip["fps"] = clip.fps
    if not sized:
        from_clip["camera"] = {"resolution": list(clip.size)}
    merged = fields.values.overridden_by(from_clip, str(path))
    if not sized:  # what else the camera lacks is missing where it is described
        merged.sources["camera"] = fields.source_of("camera")
    return Fields(merged, fields.where)


def _markers(markers: Mapping[str, MarkerFields], where: str) -> tuple[MarkerStyle, ...]:
    styles: list[MarkerStyle] = []
    seen: dict[tuple[int, int, int], str] = {}
    for name, marker in markers.items():
        segment = marker.segment or name
        if segment not in MARKER_SEGMENTS:
            raise InputError(
                f"{where}: {shown(name)} is bound to the unknown segment {shown(segment)}; "
                f"known are {listed(MARKER_SEGMENTS)}"
            )
        red, green, blue = map(round, marker.color_srgb)
        twin = seen.setdefault((red, green, blue), name)
        if twin != name:
            raise InputError(
                f"{where}: {shown(twin)} and {shown(name)} have the same color_srgb {[red, green, blue]}; "
                "each marker needs a color of its own"
            )
        styles.append(MarkerStyle(name, segment, (red, green, blue)))
    return tuple(styles)
