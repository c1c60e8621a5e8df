"""A new `shoot.json`: filled in from a survey of the clips, null and a comment where a person must say it."""

from collections import Counter
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..arrays import Image
from ..camera.camera import EYE_HEIGHT_M, default_camera_pose, guess_lens
from ..errors import InputError, pluralize
from ..files.fields import listed
from ..markers.color_model import StrongColor, strong_colors
from ..prior.texts import EVERY_LIBRARY
from ..progress import run
from ..take.description import KEYFRAME_FILE, KEYPOINT_FILE, SCHEMA_VERSION, TAKE_FILE, sidecar_file
from ..take.evidence import KEYPOINTS, MARKERS
from ..video.clip import Clip, sample_spread_frames
from .discovery import Shoot

COLORED_CLIPS = 48
"""Clips that are sampled for colors at most: a few of every day, of all performers."""
GARMENT_HUES = 4
"""Strong hues that five garments show at least; plain clothes, skin and a room seldom have as many."""


@dataclass(frozen=True)
class SurveyedClip:
    """A clip that can be opened."""

    name: str
    size: tuple[int, int]
    """Width and height [px]."""
    fps: float | None
    """Frames per second; None for images, which have no rate."""
    frames: int
    posed: bool
    detected: bool = False
    hues: int | None = None
    """Number of hues of its strong colors; None where it was not sampled."""

    @property
    def evidence(self) -> tuple[str, ...]:
        """The kinds of evidence that it seems to have, but for contours, which every clip has."""
        colored = self.hues is not None and self.hues >= GARMENT_HUES
        return (MARKERS,) * colored + (KEYPOINTS,) * self.detected


@dataclass(frozen=True)
class ClipSurvey:
    """The clips of a folder, their sizes and rates counted."""

    clips: tuple[SurveyedClip, ...]
    described: tuple[str, ...]
    """Names of takes that have a description of their own."""
    unreadable: tuple[str, ...]
    """A sentence on each clip that cannot be opened."""
    colors: tuple[StrongColor, ...] = ()

    @property
    def sizes(self) -> Counter[tuple[int, int]]:
        """Number of clips of each size."""
        return Counter(clip.size for clip in self.clips)

    @property
    def rates(self) -> Counter[float | None]:
        """Number of clips of each rate."""
        return Counter(clip.fps for clip in self.clips)

    @property
    def any_posed(self) -> bool:
        """Whether any clip has keyframes, which need the camera that they were posed through."""
        return self.unposed < len(self.clips)

    @property
    def unposed(self) -> int:
        """Number of clips without keyframes."""
        return sum(not clip.posed for clip in self.clips)


def survey_clips(shoot: Shoot) -> Generator[float, None, ClipSurvey]:
    """Open every clip of a shoot, and sample the colors of some."""
    seen: list[SurveyedClip] = []
    described: list[str] = []
    unreadable: list[str] = []
    opened: list[Clip] = []
    for done, take in enumerate(shoot.takes):
        yield 0.8 * done / len(shoot.takes)
        own = (take.path / TAKE_FILE).exists()
        if own or sidecar_file(take.path, TAKE_FILE).exists():
            described.append(take.name)
        if own:
            continue
        try:
            clip = Clip.open(take.path)
        except InputError as error:
            unreadable.append(str(error))
            continue
        opened.append(clip)
        fps = round(clip.fps, 6) if clip.knows_its_rate else None
        posed, detected = (
            sidecar_file(take.path, ending).exists() for ending in (KEYFRAME_FILE, KEYPOINT_FILE)
        )
        seen.append(SurveyedClip(take.name, clip.size, fps, clip.frame_count, posed, detected))
    images: dict[int, Sequence[Image]] = {}
    chosen = _spread(len(opened), COLORED_CLIPS)
    for done, index in enumerate(chosen):
        yield 0.8 + 0.2 * done / len(chosen)
        images[index] = run(sample_spread_frames(opened[index], 4)).images
        seen[index] = replace(seen[index], hues=len({one.hue for one in strong_colors(images[index])}))
    yield 1.0
    # Of the clips that show garments, where there are any.
    shown = [index for index in chosen if MARKERS in seen[index].evidence] or chosen
    listed = [image for one in _spread(len(shown), 6) for image in images[shown[one]]]
    return ClipSurvey(tuple(seen), tuple(described), tuple(unreadable), strong_colors(listed))


def _spread(count: int, most: int) -> list[int]:
    return list(range(count))[:: max(-(-count // most), 1)]


USUAL_MARKERS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
MOST_NAMED = 5
NO_MARKERS = [
    "left out, for no garments in strong colors were found; where some are worn, it must say which:",
    '"trunk": {"color_srgb": [red, green, blue]}, "forearm.L": ... inside braces',
]


FOUND_CAMERA = [
    "left out, for it is found in each clip, by whoever stands or walks upright and by the lines of a room.",
    "More exact is to state it, inside braces: lens_mm and sensor_width_mm, and where it stood still,",
    "height_m above the floor and tilt_deg, negative where it looked down; the lens alone helps as well.",
]


def shoot_template(survey: ClipSurvey, below_another: bool) -> dict[str, Any]:
    """The fields of a new `shoot.json` in order; `below_another`: it inherits from a parent folder's."""
    fields: dict[str, Any] = {
        "//": [
            "Describes all clips in this folder and below. Fill in every null, look at what is called a",
            "guess, then run keymark check on the folder: it says what is missing or seems wrong.",
            "What begins with // is a comment. What holds for some clips only goes into a shoot.json in",
            "their folder, or into NAME.take.json beside the clip NAME: the nearest file counts.",
        ],
        "//clips": clip_lines(survey),
        "schema_version": SCHEMA_VERSION,
    }
    if not below_another:
        fields |= {"//root": "nothing above this folder is inherited", "root": True}
    rates = [fps for fps in survey.rates if fps is not None]
    images = [clip.name for clip in survey.clips if clip.fps is None]
    if len(rates) == 1:
        fields["fps"] = int(rates[0]) if rates[0].is_integer() else rates[0]
    elif not rates:
        fields |= {"//fps": "frames per second, which images cannot tell", "fps": None}
    else:
        beside = ", but for images, beside which NAME.take.json must say it: "
        these = f"{beside}{listed(images, MOST_NAMED)}" if images else ""
        fields["//fps"] = f"left out, for the clips differ: each tells its own{these}"
    fields |= {"camera": _camera(survey)} if survey.any_posed else {"//camera": FOUND_CAMERA}
    fields["//evidence"] = [
        "what a motion is held against: markers, keypoints, depth_hints, contours; all there is, unless",
        '"evidence" says which. What the clips have:',
        *evidence_lines(survey),
    ]
    worn = any(MARKERS in clip.evidence for clip in survey.clips)
    fields |= {"markers": _markers(survey)} if worn else {"//markers": NO_MARKERS}
    fields["actor"] = {
        "//height_m": "the performer's height in meters; lengths measured one by one (segments_m) are better",
        "height_m": None,
    }
    return fields | _keyframes(survey)


def clip_lines(survey: ClipSurvey) -> list[str]:
    """Sizes, rates and described clips with their numbers, one line each."""
    frames = sum(clip.frames for clip in survey.clips)
    lines = [f"{pluralize(len(survey.clips), 'clip')}, {pluralize(frames, 'frame')} in all"]
    lines += [
        f"{pluralize(count, 'clip')} of {size[0]} x {size[1]} pixels"
        + _examples(survey, [clip.name for clip in survey.clips if clip.size == size])
        for size, count in survey.sizes.most_common()
    ]
    lines += [
        f"{pluralize(count, 'clip')} "
        + ("of images, whose rate nothing tells" if fps is None else f"at {fps:g} frames per second")
        + _examples(survey, [clip.name for clip in survey.clips if clip.fps == fps])
        for fps, count in survey.rates.most_common()
    ]
    if survey.described:
        lines.append(
            f"described already, which counts before what stands here: {listed(survey.described, MOST_NAMED)}"
        )
    lines += [f"cannot be read: {sentence}" for sentence in survey.unreadable[:MOST_NAMED]]
    if len(survey.unreadable) > MOST_NAMED:
        lines.append(f"and {len(survey.unreadable) - MOST_NAMED} more cannot be read")
    return lines


def _camera(survey: ClipSurvey) -> dict[str, Any]:
    size = survey.sizes.most_common(1)[0][0]
    lens = guess_lens(size)
    distance = -default_camera_pose(lens.lens_mm, lens.sensor_width_mm, size)[1, 3]
    camera: dict[str, Any] = {
        "//lens_mm": f"{lens.source}; state the one you filmed with, and its sensor's width",
        "lens_mm": lens.lens_mm,
        "sensor_width_mm": lens.sensor_width_mm,
    }
    if len(survey.sizes) == 1:
        camera["resolution"] = list(size)
    else:
        camera["//resolution"] = [
            "left out, for the clips differ: each tells its own; say so nearer to those that were filmed",
            "with another lens or from elsewhere",
        ]
    camera["//height_m"] = [
        "height of the camera above the floor in meters; a phone in standing hands is at about",
        f"{EYE_HEIGHT_M:g}. Blender finds it with any of the clips: Load Footage, then From Lines or",
        "From the Performer in the step Clip.",
    ]
    camera["height_m"] = None
    camera["//tilt_deg"] = [
        "degrees by which it looked up, negative where it looked down, 0 where it was level; also roll_deg,",
        "where it was turned about its view, counterclockwise for its operator.",
    ]
    camera["tilt_deg"] = None
    camera["//distance_m"] = [
        "from the camera to the world's origin, about where the performer is to stand in the result; with",
        f"this lens a whole person fits the picture from {distance:.1f} on. It changes nothing else.",
    ]
    camera["distance_m"] = round(distance, 1)
    return camera


def evidence_lines(survey: ClipSurvey) -> list[str]:
    """What each clip seems to have for its motion to be held against, clips of one kind in one line."""
    clips: dict[tuple[bool, bool | None], list[str]] = {}
    for clip in survey.clips:
        colored = None if clip.hues is None else MARKERS in clip.evidence
        clips.setdefault((clip.detected, colored), []).append(clip.name)
    lines = []
    for (detected, colored), names in clips.items():
        seen = {True: "strong colors, as of markers", False: "no garments in strong colors", None: ""}
        found = "keypoints beside it" if detected else ""
        words = " and ".join(filter(None, (seen[colored], found))) or "not looked at for colors"
        detected_later = "; keypoints are detected when it is converted"
        own = "; keypoints of a detector (keymark detect), else contours alone"
        advice = own if survey.any_posed else detected_later
        words += "" if detected or colored else advice
        lines.append(f"{pluralize(len(names), 'clip')}: {words} ({listed(names, MOST_NAMED)})")
    return lines


def _markers(survey: ClipSurvey) -> dict[str, Any]:
    markers: dict[str, Any] = {
        "//": [
            "red, green and blue from 0 to 255, as an eyedropper gives them on the marker in a clip; .L is",
            "the performer's own left. Take out markers that were not worn; clips in which none are worn say",
            '"markers": null in NAME.take.json beside them.',
        ]
    }
    if survey.colors:
        markers["//seen"] = [
            "Strong colors that some of the clips show; which is on which limb is for you to say:",
            *(
                f"{color.hue} {list(color.color_srgb)}, {100.0 * color.share:.2f} % of the picture"
                for color in survey.colors
            ),
        ]
    return markers | {name: {"color_srgb": None} for name in USUAL_MARKERS}


def _keyframes(survey: ClipSurvey) -> dict[str, Any]:
    if not survey.unposed:
        return {}
    missing = "no clip has" if survey.unposed == len(survey.clips) else f"{survey.unposed} clips have no"
    fields: dict[str, Any] = {
        "//keyframes": [
            f"{missing} keyframes (NAME.keyframes.json beside the clip NAME): auto finds them in the",
            "footage with all libraries. Where all clips show one kind of motion, library with a name out of",
            "keymark library list, in place of this, matches that alone. Posed keyframes are more exact;",
            "beside found ones a few are enough.",
        ],
        "keyframes": EVERY_LIBRARY,
    }
    if survey.any_posed:
        words = "height of the floor in the world; 0 where height_m above is the height over it"
        fields |= {"//floor_m": words, "floor_m": 0.0}
    return fields


def _examples(survey: ClipSurvey, names: list[str]) -> str:
    """Names of clips that are alike, unless they are half of all or more."""
    return f": {listed(names, MOST_NAMED)}" if 2 * len(names) < len(survey.clips) else ""
