"""What a detector saw, held against the clip: frames, picture size, scores, and what was seen at all.

Nothing is shifted without a word.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .. import MOST_FRAMES
from ..arrays import Array, BoolArray
from ..errors import InputError, pluralize
from .detected_frames import DetectedFrames
from .keypoints import People, SeenPeople, confidences
from .performer import repeated_results


def held_against_clip(
    detected: DetectedFrames,
    frame_count: int | None,
    size: tuple[int, int],
    fps: float | None,
    frame_start: int,
    stored_size: tuple[int, int] | None = None,
) -> People:
    """The people of each frame of the clip, in its pixels; `frame_count` and `fps` are None where unknown.

    `stored_size` is that of its pictures in the file, whose pixels need not be square.

    A point is not seen where its score is 0, where it lies at exactly (0, 0), which stands for nothing found,
    and outside the picture, where a network can only guess.

    Raises:
        InputError: It is of another clip, or nobody is seen in it.
    """
    time_s = detected.time_s
    if time_s is not None and not detected.numbered and fps is not None and frame_count != len(time_s):
        numbers = np.round(time_s * fps).astype(np.int64)
        if (np.diff(numbers) > 0).all() and frame_count is not None and numbers[-1] < frame_count:
            by_number = dict(zip(numbers.tolist(), detected.people.values(), strict=True))
            detected = replace(detected, people=by_number, numbered=True)
    fit = _fit_numbered if detected.numbered else _fit_listed
    aligned = fit(detected, frame_count, fps, frame_start)
    if aligned.frame_count > MOST_FRAMES:
        raise InputError(
            f"{detected.where}: has {aligned.frame_count} frames; at most {MOST_FRAMES} are read"
        )
    everyone, notes = _everyone(detected, size, stored_size or size)
    points, first = len(detected.layout.numbers), 0
    nobody = SeenPeople.nobody(points)
    frames = [nobody] * aligned.frame_count
    for number, people in detected.people.items():
        rows = np.arange(first, first + len(people))
        first += len(people)
        rows = rows[(everyone.score[rows] > 0.0).any(axis=-1)]
        index = number - aligned.first
        if len(rows) and 0 <= index < aligned.frame_count:
            frames[index] = everyone.only(rows)
    if not any(len(frame.pixel) for frame in frames):
        raise InputError(f"{detected.where}: nobody is seen in any frame of the clip; it must show a person")
    again = [] if detected.by_hand else repeated_results(frames)
    for index in again:
        frames[index] = nobody
    if again:
        there = sum(len(frame.pixel) > 0 for frame in frames)
        if there == 1:  # one result alone is no motion
            raise InputError(
                f"{detected.where}: has the same result in each of its {len(again) + 1} frames with people, "
                "as of a program that is stuck; it must have one for every frame"
            )
        notes += (
            f"{detected.where}: {len(again)} of {there + len(again)} results "
            f"{'repeats' if len(again) == 1 else 'repeat'} the one before, as of a "
            "program that looks at some frames only; each counts once",
        )
    # The file's name alone: notes go into results, which are the same in any folder.
    name = Path(detected.where).name or detected.where
    notes = tuple(note.replace(detected.where, name) for note in aligned.notes + notes)
    seen = (detected.layout.names, detected.source, size, tuple(frames))
    by_hand, second = detected.by_hand, detected.second
    return People(*seen, file=detected.where, by_hand=by_hand, notes=notes, second=second)


def _everyone(
    detected: DetectedFrames, size: tuple[int, int], stored_size: tuple[int, int]
) -> tuple[SeenPeople, tuple[str, ...]]:
    """The people of all frames one after the other, and sentences on what was changed."""
    numbers, where = detected.layout.numbers, detected.where
    persons = [person for people in detected.people.values() for person in people]
    place = np.stack([person.place[numbers] for person in persons])
    scale, notes = _scale(detected, place, size, stored_size)
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
    hint = np.full((*seen.shape, 3), np.nan)
    for row, person in enumerate(persons):
        if person.hint_m is not None:
            hint[row] = person.hint_m[numbers]
    # What a network guesses of a motion beyond the picture is none of a point that is seen.
    beyond = len(numbers) - (len(detected.second.names) if detected.second and detected.second.motion else 0)
    hint[:, :beyond][~seen[:, :beyond]] = np.nan
    face, hands = np.stack([one.face for one in persons]), np.stack([one.hands for one in persons])
    looks = SeenPeople(place, score, hint, face, hands).moved(partial(np.multiply, scale))
    return replace(looks, pixel=place), notes + score_notes


def _scale(
    detected: DetectedFrames, place: Array, size: tuple[int, int], stored_size: tuple[int, int]
) -> tuple[Array, tuple[str, ...]]:
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
    if detected.size != stored_size and abs(wanted - height) > 1.0 + width / clip_width:
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


# --- Which frame of the clip each frame of a result is


class Alignment(NamedTuple):
    """How a result's frames lie in the clip."""

    first: int  # number of the clip's first frame in the result
    frame_count: int  # frames of the clip
    notes: tuple[str, ...] = ()  # sentences on what was taken for granted


def tolerance(frame_count: int) -> int:
    """By how many frames a result may be longer or shorter than the clip."""
    return max(2, round(0.01 * frame_count))


def _fit_listed(
    detected: DetectedFrames, frame_count: int | None, fps: float | None, frame_start: int
) -> Alignment:
    """Of a list with one entry a frame, beginning with the clip's first."""
    where, count, start = detected.where, len(detected.people), detected.frame_start
    frames = count if frame_count is None else frame_count
    notes: list[str] = []
    of_rate = ""
    if fps is not None and detected.fps is not None and abs(detected.fps - fps) > 0.01 * fps:
        of_rate = f"{detected.fps:g} frames per second, the clip has {fps:g}"  # 29.97 and 30 are one
    has = f"{where}: has {pluralize(count, 'frame')}, the clip {frames}; "
    if abs(count - frames) > tolerance(frames):
        why = f"; it was made at {of_rate}" if of_rate else _rate_words(count, frames)
        raise InputError(
            f"{has}it must have one entry for every frame of the clip, null where nobody was seen{why}"
        )
    if count != frames:
        rest = "the last are not used" if count > frames else "in the last ones nobody is seen"
        notes.append(f"{has}the first are the same, {rest}")
    if start not in (None, frame_start):
        if count != frames:
            raise InputError(
                f"{where}: frame_start is {start} and its {count} entries are not the clip's {frames} "
                f"frames, which begin with {frame_start}; it must have one for every frame"
            )
        notes.append(
            f"{where}: frame_start is {start}, that of the clip is {frame_start}; the first entry was taken "
            "for the clip's first frame"
        )
    if of_rate and count == frames:
        notes.append(f"{where}: says {of_rate}; it was taken frame by frame")
    return Alignment(0, frames, tuple(notes))


def _fit_numbered(
    detected: DetectedFrames, frame_count: int | None, fps: float | None, frame_start: int
) -> Alignment:
    """Of frames that carry numbers, which count from 0, from 1, from the scene's first frame or otherwise."""
    where, numbers = detected.where, set(detected.people)
    lowest, highest = min(numbers), max(numbers)
    bases = sorted({0, 1, frame_start})
    if frame_count is None:
        if lowest not in bases or highest - lowest >= MOST_FRAMES:
            raise InputError(
                f"{where}: its frames are numbered {lowest} to {highest}; they must begin with 0, 1 or the "
                f"clip's first scene frame, and be at most {MOST_FRAMES}"
            )
        return Alignment(lowest, highest - lowest + 1)
    if detected.time_s is not None and fps is not None:  # times count from the clip's first frame
        first = round(float(np.median(np.array(list(detected.people)) - fps * detected.time_s)))
        if first <= lowest and highest < first + frame_count:
            return Alignment(first, frame_count)
    length = highest - lowest + 1
    fitting = [base for base in bases if base <= lowest and highest < base + frame_count]
    notes: list[str] = []
    if length == frame_count:
        fitting = [lowest]
    elif not fitting and lowest in bases and length <= frame_count + tolerance(frame_count):
        notes.append(
            f"{where}: goes on to frame {highest}, beyond the clip's {frame_count} frames; they are left out"
        )
        fitting = [lowest]
    if not fitting:
        raise InputError(
            f"{where}: its frames are numbered {lowest} to {highest}; the clip has {frame_count}, so they "
            f"must lie within 0 to {frame_count - 1} or 1 to {frame_count}{_rate_words(length, frame_count)}"
        )
    fitting = [base for base in fitting if lowest == base or highest == base + frame_count - 1] or fitting
    first = fitting[0]
    at_end = frame_count - 1 - (highest - first)
    if detected.complete and at_end > tolerance(frame_count):
        raise InputError(
            f"{where}: ends with frame {highest}, {pluralize(at_end, 'frame')} before the clip's last; every "
            f"frame must be there, also where nobody was seen{_rate_words(length, frame_count)}"
        )
    if len(fitting) > 1 and len(numbers) < frame_count:
        notes.append(
            f"{where}: its frames were taken to count from {first}; no frame tells for certain, so check "
            "that they lie on the performer"
        )
    missing = frame_count - sum(0 <= number - first < frame_count for number in numbers)
    if detected.complete and missing:
        notes.append(f"{where}: lacks {missing} of {pluralize(frame_count, 'frame')}; nobody is seen there")
    return Alignment(first, frame_count, tuple(notes))


def _rate_words(count: int, frame_count: int) -> str:
    """The rest of the sentence where one is a multiple of the other: the detector saw another rate."""
    few, many = sorted((count, frame_count))
    times = round(many / max(few, 1))
    if not 2 <= times <= 10 or abs(many - times * few) > times:
        return ""
    what = f"one for every {times}" if count < frame_count else f"{times} for every one"
    return f"; it has about {what} of the clip, as if made at another frame rate"
