"""Shots: of a clip that is cut, the one that is animated; all that follows sees nothing of the others."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from ..arrays import BoolArray
from ..detect.keypoints import SeenPeople
from ..errors import InputError
from ..markers.reading import Reading, without_tracks
from .take import Take


def shot_of(take: Take, reading: Reading, named: tuple[int, int] | None = None) -> tuple[int, int] | None:
    """First frame of the shot that is animated and the one after its last; None where the clip is not cut.

    It is the one that is `named` by its first and last frame, or that is posed, else the one in which
    somebody is seen longest. Who has posed several says that they are one: None, too.

    Raises:
        InputError: The named frames are not those of the clip.
    """
    count, cuts, start = reading.tracks.frame_count, reading.frame_findings.cuts, take.frame_start
    if named is not None:
        first, last = named[0] - start, named[1] - start
        if not 0 <= first < last < count:
            raise InputError(
                f"frames {named[0]} to {named[1]} are not all in {take.clip.name}, whose frames are {start} "
                f"to {start + count - 1}"
            )
        return first, last + 1
    if not cuts:
        return None
    shots = [*pairwise([0, *cuts, count])]
    posed = [key.index for key in take.keyframes if key.matched is None]
    if posed:
        holding = [shot for shot in shots if any(shot[0] <= index < shot[1] for index in posed)]
        return holding[0] if len(holding) == 1 else None
    seen = reading.tracks.visible.any(axis=1)
    for people in take.keypoints:
        there = [len(frame.pixel) > 0 for frame in people.frames[:count]]
        seen[: len(there)] |= there
    return max(shots, key=lambda shot: (int(seen[slice(*shot)].sum()), shot[1] - shot[0]))


def of_one_shot(take: Take, reading: Reading, named: tuple[int, int] | None = None) -> tuple[Take, Reading]:
    """The take and its reading with nothing seen but in the shot that is animated, and a sentence on it."""
    shot, findings = shot_of(take, reading, named), reading.frame_findings
    if shot is None:
        return take, reading
    first, last = shot
    others = [*range(first), *range(last, reading.tracks.frame_count)]
    keypoints = []
    for people in take.keypoints:
        nobody = SeenPeople.nobody(len(people.names))
        frames = tuple(seen if first <= index < last else nobody for index, seen in enumerate(people.frames))
        keypoints.append(replace(people, frames=frames))
    start = take.frame_start
    cut = findings.cut_note(start) if findings.cuts else ""
    whose = f"the motion is that of frames {first + start} to {last - 1 + start} and empty elsewhere"
    animated = f"{cut}; {whose}: --frames names another shot" if named is None else whose
    own = replace(
        reading,
        tracks=without_tracks(reading.tracks, others),
        album=None if reading.album is None else reading.album.excluding(others),
        glimpses=None if reading.glimpses is None else reading.glimpses.excluding(others),
        notes=(animated, *(note for note in reading.notes if note != cut)),
        shot=shot,
    )
    posed = tuple(key for key in take.keyframes if first <= key.index < last)
    return replace(take, keypoints=tuple(keypoints), keyframes=posed), own


def within_shot(reading: Reading) -> BoolArray:
    """(F,) whether each frame is one of the shot that is animated."""
    within = np.zeros(reading.tracks.frame_count, dtype=np.bool_)
    within[slice(*(reading.shot or (0, None)))] = True
    return within
