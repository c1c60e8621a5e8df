"""What a detector saw, held against the clip: frames, picture size, scores, and what was seen at all."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..arrays import Array, BoolArray
from ..errors import InputError
from .continuity import repeated_results
from .detected_frames import DetectedFrames, DetectedPerson, check_points
from .frame_folder import MOST_FRAMES, Alignment, align_listed, align_numbered
from .keypoints import People, SeenPeople, confidences
from .stated_frames import numbers_by_time


def held_against_clip(
    detected: DetectedFrames,
    frame_count: int | None,
    size: tuple[int, int],
    fps: float | None,
    frame_start: int,
) -> People:
    """The people of each frame of the clip, in its pixels; `frame_count` and `fps` are None where unknown.

    A point is not seen where its score is 0, where it lies at exactly (0, 0), which stands for nothing found,
    and outside the picture, where a network can only guess.

    Raises:
        InputError: It is of another clip, or nobody is seen in it.
    """
    if not any(detected.people.values()):
        raise InputError(
            f"{detected.where}: nobody is seen in any of its {len(detected.people)} frames; "
            "it must show a person"
        )
    if detected.time_s is not None and not detected.numbered:
        numbers = numbers_by_time(detected.time_s, fps, frame_count)
        if numbers is not None:
            by_number = dict(zip(numbers, detected.people.values(), strict=True))
            detected = replace(detected, people=by_number, numbered=True)
    aligned = _aligned(detected, frame_count, fps, frame_start)
    everyone, notes = _everyone(detected, size)
    points, first = len(detected.layout.numbers), 0
    nobody = SeenPeople.nobody(points)
    frames = [nobody] * aligned.frame_count
    for number, people in detected.people.items():
        rows = np.arange(first, first + len(people))
        first += len(people)
        rows = rows[(everyone.score[rows] > 0.0).any(axis=-1)]
        index = number - aligned.first
        if len(rows) and 0 <= index < aligned.frame_count:
            frames[index] = SeenPeople(everyone.pixel[rows], everyone.score[rows], everyone.hint_m[rows])
    if not any(len(frame.pixel) for frame in frames):
        raise InputError(f"{detected.where}: nobody is seen in any frame of the clip; it must show a person")
    again = [] if detected.by_hand else repeated_results(frames)
    for index in again:
        frames[index] = nobody
    notes += _repeat_notes(detected.where, frames, len(again))
    # The file's name alone: notes go into results, which are the same in any folder.
    name = Path(detected.where).name or detected.where
    notes = tuple(note.replace(detected.where, name) for note in aligned.notes + notes)
    seen = (detected.layout.names, detected.source, size, tuple(frames))
    return People(*seen, file=detected.where, by_hand=detected.by_hand, notes=notes)


def _repeat_notes(where: str, frames: list[SeenPeople], repeated: int) -> tuple[str, ...]:
    """A sentence on results that repeat the one before; one result alone is no motion."""
    if not repeated:
        return ()
    there = sum(len(frame.pixel) > 0 for frame in frames)
    if there == 1:
        raise InputError(
            f"{where}: has the same result in each of its {repeated + 1} frames with people, as of a program "
            "that is stuck; it must have one for every frame"
        )
    note = (
        f"{where}: {repeated} of {there + repeated} results repeat the one before, as of a program that "
        "looks at some frames only; each counts once"
    )
    return (note,)


def _everyone(detected: DetectedFrames, size: tuple[int, int]) -> tuple[SeenPeople, tuple[str, ...]]:
    """The people of all frames one after the other, and sentences on what was changed."""
    numbers, where = detected.layout.numbers, detected.where
    persons = [person for people in detected.people.values() for person in people]
    check_points(len(persons) * detected.layout.count, where)
    place = np.stack([person.place[numbers] for person in persons])
    scale, notes = _scale(detected, place, size)
    place *= scale
    scores = np.stack([person.score[numbers] for person in persons])
    placed = np.isfinite(place).all(axis=-1) & place.any(axis=-1)
    score = np.zeros(placed.shape)
    score[placed], score_notes = confidences(scores[placed], where)
    seen = placed & (np.nan_to_num(score) > 0.0)
    inside = ((place >= 0.0) & (place <= np.array(size))).all(axis=-1)
    _check_places(detected, place, seen, inside, size)
    seen &= inside
    place[~seen], score[~seen] = np.nan, 0.0
    return SeenPeople(place, score, _hints(persons, numbers, seen)), notes + score_notes


def _aligned(
    detected: DetectedFrames, frame_count: int | None, fps: float | None, frame_start: int
) -> Alignment:
    where = detected.where
    if detected.numbered:
        first = None
        if detected.time_s is not None and fps is not None:  # times count from the clip's first frame
            first = round(float(np.median(np.array(list(detected.people)) - fps * detected.time_s)))
        aligned = align_numbered(detected.people, frame_count, frame_start, where, detected.complete, first)
    else:
        rates, why = None, ""
        if fps is not None and detected.fps is not None and abs(detected.fps - fps) > 0.01 * fps:
            rates = (detected.fps, fps)  # 29.97 and 30 are one
            why = f"; it was made at {rates[0]:g} frames per second, the clip has {rates[1]:g}"
        count = len(detected.people)
        aligned = align_listed(count, frame_count, where, why)
        notes = aligned.notes
        start = detected.frame_start
        if start not in (None, frame_start):
            if frame_count is not None and count != frame_count:
                raise InputError(
                    f"{where}: frame_start is {start} and its {count} entries are not the clip's "
                    f"{frame_count} frames, which begin with {frame_start}; it must have one for every frame"
                )
            note = (
                f"{where}: frame_start is {start}, that of the clip is {frame_start}; the first "
                "entry was taken for the clip's first frame"
            )
            notes += (note,)
        if rates and aligned.frame_count == count:
            note = (
                f"{where}: says {rates[0]:g} frames per second, the clip has {rates[1]:g}; it was "
                "taken frame by frame"
            )
            notes += (note,)
        aligned = Alignment(aligned.first, aligned.frame_count, notes)
    if aligned.frame_count > MOST_FRAMES:
        raise InputError(f"{where}: has {aligned.frame_count} frames; at most {MOST_FRAMES} are read")
    return aligned


def _scale(detected: DetectedFrames, place: Array, size: tuple[int, int]) -> tuple[Array, tuple[str, ...]]:
    """(2,) clip pixels per unit of the places; only whole pictures are scaled."""
    known = place[np.isfinite(place) & place.any(axis=-1, keepdims=True)]
    # Guesses outside 0 to 1 are the exception.
    shares = detected.shares and (not len(known) or np.median(np.abs(known)) <= 2.0)
    unit = np.array(size, dtype=np.float64) if shares else np.ones(2)
    if detected.size in (None, size):
        return unit, ()
    assert detected.size is not None
    (width, height), (clip_width, clip_height) = detected.size, size
    # The height that fits the other's width may differ by the rounding of both.
    wanted = clip_height * width / clip_width
    if abs(wanted - height) > 1.0 + width / clip_width:
        turned = " (it was turned: width and height are swapped)" if size == (height, width) else ""
        raise InputError(
            f"{detected.where}: size is {[width, height]}, that of the clip is {list(size)}{turned}; the "
            "proportions must be the same, so the keypoints must be found again in this clip"
        )
    if shares:
        return unit, ()
    note = (
        f"{detected.where}: was found in pictures of {width} x {height}; scaled to the clip's "
        f"{clip_width} x {clip_height}"
    )
    return np.array([clip_width / width, clip_height / height]), (note,)


def _check_places(
    detected: DetectedFrames, place: Array, seen: BoolArray, inside: BoolArray, size: tuple[int, int]
) -> None:
    """Refuse places most of which are outside the picture, or all in its corner, as shares of it would be."""
    if not seen.any():
        raise InputError(f"{detected.where}: no point has a score above 0; it must show a person")
    reach = float(np.abs(place[seen]).max())
    if reach <= 2.5 < min(size) / 2:
        raise InputError(
            f"{detected.where}: all coordinates lie within {reach:.3g} of 0, as shares of a picture do; they "
            "must be pixels of the clip (OpenPose writes them with --keypoint_scale 0)"
        )
    if (seen & ~inside).sum() > 0.5 * seen.sum():
        x, y = np.median(place[seen], axis=0)
        raise InputError(
            f"{detected.where}: most points lie outside the clip's picture, around ({x:.0f}, {y:.0f}); "
            f"they must be pixels of the clip, which is {size[0]} x {size[1]}"
        )


def _hints(persons: list[DetectedPerson], numbers: list[int], seen: BoolArray) -> Array:
    """(S, N, 3) the guessed points of everyone [m], NaN where there are none."""
    hint = np.full((*seen.shape, 3), np.nan)
    for row, person in enumerate(persons):
        if person.hint_m is not None:
            hint[row] = person.hint_m[numbers]
    hint[~seen] = np.nan
    return hint
