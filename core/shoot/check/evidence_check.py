"""Findings of a check, and the checks of a take's keyframes, keypoints and clip from a few of its frames."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...detect.keypoints import Keypoints, People, mirrored_point
from ...errors import MOST_NAMED, KeymarkError
from ...files.fields import listed
from ...markers.ignored_regions import IGNORED_REGIONS, IgnoredRegion, ignored_region_fields
from ...markers.marker_check import MarkerCheck, MarkerReadout, check_markers
from ...markers.region_tracks import is_variable_frame_rate
from ...progress import run
from ...take.performer_keypoints import performer_keypoints
from ...take.read_footage import (
    VARIABLE_RATE,
    check_frame_count,
    check_in_front,
    check_size,
    expected_regions,
    rate_note,
)
from ...take.take import Take
from ...video.clip import SAMPLED_FRAMES, Clip, ClipSamples, sample_spread_frames
from ...video.container import read_packets
from ...video.image_sequence import ImageSequence
from ...video.video_file import VideoFile


class Findings:
    """Sentences on a take: problems stop its conversion, warnings are what is likely to go wrong."""

    def __init__(self) -> None:
        self.problems: dict[str, None] = {}
        self.warnings: dict[str, None] = {}

    def problem(self, *sentences: str) -> None:
        """Add problems; the same sentence is kept once."""
        self.problems |= dict.fromkeys(sentences)

    def warn(self, *sentences: str) -> None:
        """Add warnings; the same sentence is kept once."""
        self.warnings |= dict.fromkeys(sentences)

    @contextmanager
    def catching(self) -> Iterator[None]:
        """Turn an error raised inside into a problem."""
        try:
            yield
        except KeymarkError as error:
            self.problem(str(error))


def check_keyframes(take: Take, frames: int, others_found: bool, findings: Findings) -> None:
    """Check keyframes that could be read."""
    if len(take.notes) <= MOST_NAMED:
        findings.warn(*take.notes)
    else:
        residual_cm = 100 * max(keyframe.residual_m for keyframe in take.keyframes)
        findings.warn(
            f"the points of {len(take.notes)} of {len(take.keyframes)} keyframes are up to "
            f"{residual_cm:.0f} cm on average from any posture of this actor; check the actor's "
            "lengths, and whether these are the performer's own keyframes"
        )
    with findings.catching():
        check_frame_count(take, frames)  # first: a moving camera may lack the poses of keyframes
        check_in_front(take)
    if findings.problems or not take.keyframes:
        return
    ends = [0, *(index for index in take.keyframe_indices if index < frames), frames - 1]
    gaps = np.diff(ends)
    longest = int(np.argmax(gaps))
    seconds = gaps[longest] / take.fps
    if seconds > 1.0 and not others_found:  # ten in 100 frames are usual
        first, last = ends[longest] + take.frame_start, ends[longest + 1] + take.frame_start
        findings.warn(
            f"{len(take.keyframes)} keyframes for {frames} frames are few: from frame {first} to "
            f"{last}, {seconds:.1f} s, there is none; pose more, or let --keyframes auto find the "
            "others"
        )
    size, outside = np.array(take.camera.resolution), []
    for keyframe in take.keyframes:
        points = take.body.points(take.body.pose(keyframe.posture))
        pixel = take.camera.project(points, keyframe.index)[0]
        if ((pixel >= 0.0) & (pixel <= size)).all(axis=-1).mean() < 0.5:
            outside.append(str(keyframe.index + take.frame_start))
    if outside:
        which = listed(outside, MOST_NAMED)
        which = f"the keyframes {which}" if len(outside) > 1 else f"keyframe {which}"
        findings.warn(
            f"through this camera {which} would be seen outside the picture for the most "
            "part; check where the camera stands and its lens"
        )


@dataclass(frozen=True)
class KeypointReadout:
    """What one file of keypoints holds."""

    file: str
    source: str
    points: int
    seen_frames: float
    seen_points: float
    """Share of the points seen in those frames."""
    people: int
    depth_hints: bool
    error_px: float | None
    """Median distance of the joints from those of posed keyframes; None without any to compare."""


def check_keypoints(take: Take, frames: int, findings: Findings) -> tuple[KeypointReadout, ...]:
    """Check every file of a take's keypoints."""
    readouts = []
    for people in take.keypoints:
        findings.warn(*people.notes)
        readouts.append(_readout(replace(take, keypoints=(people,), frame_count=frames), people, findings))
    return tuple(readouts)


def _readout(take: Take, people: People, findings: Findings) -> KeypointReadout:
    name = Path(people.file).name or people.source
    performer = performer_keypoints(take)
    # One person all along is compared even where the keyframes have somebody else perform.
    compared = performer if people.most_people > 1 else performer_keypoints(replace(take, keyframes=()))
    error = _check_agreement(take, compared, name, findings)
    found = performer.seen.any(axis=1)
    share = float(found.mean())
    if share < 0.5:
        findings.warn(
            f"{name}: the performer is seen in {share:.0%} of the frames only; a keyframe in each gap helps"
        )
    if people.most_people > 1 and not take.keyframes and not people.by_hand:
        findings.warn(
            f"{name}: shows up to {people.most_people} people, and no keyframe says which of them "
            "performs; the largest who is there longest is taken"
        )
    return KeypointReadout(
        file=name,
        source=people.source,
        points=len(people.names),
        seen_frames=share,
        seen_points=float(performer.seen[found].mean()) if found.any() else 0.0,
        people=people.most_people,
        depth_hints=bool(np.isfinite(performer.hint_m).any()),
        error_px=error,
    )


def _check_agreement(take: Take, performer: Keypoints, name: str, findings: Findings) -> float | None:
    """Median distance from the posed joints [px]; warns where it is too large, and says of what it looks.

    Detectors place hips and shoulders up to half as far from the joint as is still one of the same person: a
    tenth of the performer's height in the picture. 3 % are the detector's error and that of posing.
    """
    posed, heights = {}, [0.0]
    for keyframe in (one for one in take.keyframes if one.matched is None):
        points = take.body.points(take.body.pose(keyframe.posture))
        pixel, _ = take.camera.project(points, keyframe.index)
        posed[keyframe.index] = dict(zip(take.body.skeleton.point_names, pixel, strict=True))
        depth = float(np.median(take.camera.depth(points, keyframe.index)))
        heights.append(float(take.camera.pixels_per_meter(depth)) * take.body.actor.stature_m)
    height_px = float(np.median(heights[1:] or heights))
    plain = _error(performer, posed, 0, str)
    if plain is None or plain <= 0.03 * height_px:
        return plain
    readings = {"left and right seem to be exchanged": _error(performer, posed, 0, mirrored_point)}
    reach = round(0.5 * take.fps)  # with a longer delay the movement may be another that looks alike
    for shift in (step for step in range(-reach, reach + 1) if step):
        when = "late" if shift > 0 else "early"
        readings[f"they seem to be {abs(shift)} frames {when}"] = _error(performer, posed, shift, str)
    known = {words: error for words, error in readings.items() if error is not None}
    best = min(known, key=lambda words: known[words], default=None)
    explained = best is not None and known[best] < 0.5 * plain
    if explained or plain > 0.1 * height_px:
        findings.warn(
            f"{name}: its joints lie {plain:.0f} px from those of the posed keyframes, where the "
            f"performer is {height_px:.0f} px tall; "
            f"{(best if explained else 'check that they are of this clip and this person')}"
        )
    return plain


def _error(
    performer: Keypoints, posed: dict[int, dict[str, Array]], shift: int, name_of: Callable[[str], str]
) -> float | None:
    """Median distance [px] of the joints seen so many frames after the keyframes, under these names."""
    distances = [
        np.linalg.norm(performer.pixel[index + shift, column] - joints[name_of(name)])
        for index, joints in posed.items()
        if 0 <= index + shift < performer.frame_count
        for column, name in enumerate(performer.names)
        if name_of(name) in joints
    ]
    known = np.array(distances)[np.isfinite(distances)] if distances else np.zeros(0)
    return float(np.median(known)) if len(known) else None


MOST_EXPECTED = 5000
"""Frames of the longest clip for which the markers' expected regions are computed."""
ASTRAY = 0.8
"""Share of a marker's regions near where keyframes put it, below which a warning is given."""


def count_frames(clip: Clip, findings: Findings) -> int:
    """Number of frames of a clip, as far as known without decoding it."""
    if isinstance(clip.source, ImageSequence):
        findings.warn(*clip.source.notes)
    video = isinstance(clip.source, VideoFile) and not clip.source.is_trimmed
    packets = read_packets(clip.path) if video else None
    if packets is None:
        return clip.frame_count
    held = len(packets.time_s)
    if packets.complete and held < clip.frame_count:
        findings.warn(
            f"{clip.path.name} claims {clip.frame_count} frames, of which about {held} are there; "
            "it may be cut off"
        )
        return held
    if is_variable_frame_rate(packets.time_s):
        findings.warn(VARIABLE_RATE)
    return clip.frame_count


def check_footage(take: Take, clip: Clip, frames: int, findings: Findings) -> tuple[MarkerReadout, ...]:
    """Check a take's clip."""
    with findings.catching():
        check_size(take, clip)
    rate = rate_note(take, clip) if clip.knows_its_rate else None
    if rate is not None:
        findings.warn(rate)
    samples = None
    with findings.catching():
        samples = run(sample_spread_frames(clip))
    if samples is None:
        return ()
    bright = np.array([np.percentile(image.max(axis=-1), 90.0) for image in samples.images])
    dark = False
    for limit, word in ((16.0, "black"), (40.0, "dark")):  # levels of 255 of the brightest tenth
        count = int(np.count_nonzero(bright < limit))
        if not dark and count >= max(0.25 * len(bright), 1):
            dark = True
            findings.warn(
                f"{count} of {len(bright)} sampled frames are {word}; colors are hard to tell there, more "
                "light is worth most"
            )
    if not take.markers:
        return ()
    check = _find_markers(take, samples, frames, findings)
    enough = len(samples.images) >= min(SAMPLED_FRAMES // 2, samples.indices[-1] + 1)
    missing = tuple(check.missing.values()) if enough else ()  # else the conversion may find them
    if len(missing) == len(take.markers) > 1:
        findings.problem(
            f"{take.clip}: the color of no marker is in any of {len(samples.images)} sampled frames; "
            + ("there is too little light" if dark else "is it a clip of this performer?")
        )
        return check.readouts
    findings.problem(*(f"{take.clip}: marker {sentence}" for sentence in missing))
    for readout in check.readouts:
        findings.warn(*(warning for warning in readout.warnings if warning not in missing))
    names = [readout.name for readout in check.readouts if readout.still_boxes]
    if names:
        boxes = dict.fromkeys(box for readout in check.readouts for box in readout.still_boxes)
        every = [*take.ignored_regions, *(IgnoredRegion(box=box) for box in boxes)]
        field = json.dumps(ignored_region_fields(every, take.frame_start))
        findings.warn(
            f"still areas have the color of {' and '.join(names)}; they are left out where {take.file.name} "
            f'says "{IGNORED_REGIONS}": {field}'
        )
    return check.readouts


def _find_markers(take: Take, samples: ClipSamples, frames: int, findings: Findings) -> MarkerCheck:
    """Search for the markers as the conversion will: near where the keyframes put them, else anywhere.

    Markers found elsewhere only are a warning: camera, keyframes or clip do not fit each other.
    """
    if findings.problems or len(take.keyframes) < 2 or frames > MOST_EXPECTED:
        return run(check_markers(samples, take.markers, ignored=take.ignored_regions))
    nearby = run(check_markers(samples, take.markers, expected_regions(take, frames), take.ignored_regions))
    if all(readout.found >= ASTRAY * readout.sampled for readout in nearby.readouts):
        return nearby
    anywhere = run(check_markers(samples, take.markers, ignored=take.ignored_regions))
    astray = [
        f"{near.name} in {free.found - near.found} of {free.found} frames"
        for free, near in zip(anywhere.readouts, nearby.readouts, strict=True)
        if near.found < ASTRAY * free.found
    ]
    if not astray:
        return nearby
    findings.warn(
        f"markers are seen far from where keyframes and camera put them: {', '.join(astray)}; check "
        "that the keyframes are this clip's, where the camera stands, and which marker is on which "
        "side"
    )
    return anywhere
