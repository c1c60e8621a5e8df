"""Check of one take before it is converted: description, clip, keyframes, evidence; and outliers."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from ...detect.pose_network import PoseNetwork
from ...files.fields import PLACED, Fields, child_location
from ...markers.marker_check import MarkerReadout
from ...poses.clip_input import check_followed
from ...session.described import described, is_detected
from ...take.conversion_settings import METHODS, NO_SETTINGS, CharacterSettings, ConversionSettings
from ...take.description import Description, effective_settings
from ...take.evidence import CONTOURS, KEYPOINTS, in_order
from ...take.read_footage import open_footage
from ...take.take import Take, check_method, evidence_of
from ...take.take_file import read_described
from ..discovery import ShootTake
from .evidence_check import (
    Findings,
    KeypointReadout,
    check_footage,
    check_keyframes,
    check_keypoints,
    count_frames,
)

_CAMERA = {
    "lens_mm": "the focal length in millimeters",
    "sensor_width_mm": "the sensor's width in millimeters, 36 where lens_mm is that of full frame",
    "height_m": "the camera's height above the floor in meters",
    "tilt_deg": "by how many degrees the camera looked up, negative where it looked down, 0 where level",
    "matrix_world": "where the camera stood, four rows of four numbers; height_m and tilt_deg do as well",
}
_POSES = ("matrix_world", "matrix_world_frames")
_PLACE = (*PLACED, *_POSES)


def find_unfilled_fields(fields: Fields) -> tuple[str, ...]:
    """A sentence on each field of a take that is null and must not be."""
    unfilled: list[tuple[Fields, str, str]] = []
    camera = _child(fields, "camera")
    posed = any(camera.has(name) for name in _POSES)
    for name, valid in _CAMERA.items():
        said_otherwise = (name in _PLACE and posed) or (name in _POSES and camera.has("height_m"))
        if name in camera.values and not camera.has(name) and not said_otherwise:
            unfilled.append((camera, name, valid))
    markers = _child(fields, "markers")
    for name in markers.values:
        marker = _child(markers, name)
        if "color_srgb" in marker.values and not marker.has("color_srgb"):
            color = "three numbers from 0 to 255, as an eyedropper gives them on the marker"
            unfilled.append((marker, "color_srgb", color))
    actor = _child(fields, "actor")
    if "height_m" in actor.values and not actor.has("height_m") and not actor.has("segments_m"):
        unfilled.append((actor, "height_m", "the performer's height in meters"))
    return tuple(
        f"{of.source_of(name)}: {name} is still to be filled in: {valid}" for of, name, valid in unfilled
    )


def _child(fields: Fields, name: str) -> Fields:
    value = fields.values.get(name)
    location = child_location(fields.source_of(name), name)
    return Fields(value if isinstance(value, Mapping) else {}, location)


READY, LOOK, FAILS = "ready", "look", "fails"


@dataclass(frozen=True, eq=False)
class TakeCheck:
    """The findings on one take."""

    name: str
    problems: tuple[str, ...]
    """Reasons why it would not convert."""
    warnings: tuple[str, ...]
    """What is likely to go wrong."""
    size: tuple[int, int] | None = None
    """Width and height of the clip [px]; None where it cannot be opened."""
    fps: float | None = None
    frames: int | None = None
    evidence: tuple[str, ...] = ()
    markers: tuple[MarkerReadout, ...] = ()
    keypoints: tuple[KeypointReadout, ...] = ()
    keyframes: int = 0
    library: str | None = None
    """Setting by which the others are found; None where all are posed."""

    @property
    def status(self) -> str:
        """Whether the take would convert, would but something is likely to go wrong, or would not."""
        return FAILS if self.problems else LOOK if self.warnings else READY


def check_take(
    found: ShootTake,
    find_libraries: Callable[[str], object],
    defaults: ConversionSettings = NO_SETTINGS,
    check_character: Callable[[CharacterSettings], Sequence[str]] = lambda _settings: (),
) -> TakeCheck:
    """Check one take; nothing is written."""
    findings = Findings()
    description = None
    with findings.catching():
        description = found.describe()
    if description is None:
        return TakeCheck(found.name, tuple(findings.problems), tuple(findings.warnings))
    settings = effective_settings(description, defaults)
    if settings.library is not None:
        with findings.catching():
            find_libraries(settings.library)
    if settings.character is not None:
        with findings.catching():
            findings.warn(*check_character(settings.character))
    clip = None
    with findings.catching():
        clip = open_footage(description.clip, None)
    missing = find_unfilled_fields(description.fields)
    findings.problem(*missing)
    frames = None if clip is None else count_frames(clip, findings)
    take = None if missing or clip is None else _read(description, settings, findings)
    evidence: tuple[str, ...] = ()
    markers: tuple[MarkerReadout, ...] = ()
    keypoints: tuple[KeypointReadout, ...] = ()
    method = settings.method or METHODS[0]
    if take is not None and clip is not None and frames is not None:
        detects = is_detected(description, settings)
        # What its motion will be held against, keypoints that are yet to be detected too.
        evidence = in_order((*evidence_of(take), *(KEYPOINTS,) * detects))
        with findings.catching():
            check_method(take, method)
        with findings.catching():
            if detects:
                PoseNetwork()
            elif settings.library is not None:
                check_followed(take)
        check_keyframes(take, frames, settings.library is not None, findings)
        keypoints = check_keypoints(take, frames, findings)
        markers = check_footage(take, clip, frames, findings)
        if evidence == (CONTOURS,) and not findings.problems:
            findings.warn(
                "the motion is held against contours alone, which tell least of all evidence; keypoints of a "
                "detector, as of keymark detect, or markers in strong colors tell more"
            )
    return TakeCheck(
        name=found.name,
        problems=tuple(findings.problems),
        warnings=tuple(findings.warnings),
        size=None if clip is None else clip.size,
        fps=clip.fps if clip is not None and clip.knows_its_rate else None if take is None else take.fps,
        frames=frames,
        evidence=evidence,
        markers=markers,
        keypoints=keypoints,
        keyframes=0 if take is None else len(take.keyframes),
        library=settings.library,
    )


def _read(description: Description, settings: ConversionSettings, findings: Findings) -> Take | None:
    """Read the take as its conversion will; without keyframes and keypoints where one is unusable."""
    with findings.catching():
        return described(description, settings).take
    with findings.catching():
        without = replace(settings, keypoints=())
        return read_described(
            description, keyframes_required=False, fewest_keyframes=0, settings=without, whole=True
        )
    return None


FEWEST_ALIKE, USUAL_SHARE = 5, 0.8
"""Number of clips, and share of them alike, from which on one that differs is an outlier."""


def flag_outliers(checks: Sequence[TakeCheck]) -> list[TakeCheck]:
    """The checks, with a warning for each clip whose size or rate is an outlier of the shoot."""
    sizes = [None if one.size is None else f"{one.size[0]} x {one.size[1]} pixels" for one in checks]
    rates = [None if one.fps is None else f"{one.fps:.4g} frames per second" for one in checks]
    warned = list(checks)
    for values in (sizes, rates):
        known = Counter(value for value in values if value is not None)
        usual, count = known.most_common(1)[0] if known else ("", 0)
        if known.total() < FEWEST_ALIKE or count < USUAL_SHARE * known.total():
            continue
        for index, own in enumerate(values):
            if own not in (None, usual):
                more = f"the clip has {own}, nearly all others have {usual}; check that it is this camera's"
                warned[index] = replace(warned[index], warnings=(*warned[index].warnings, more))
    return warned
