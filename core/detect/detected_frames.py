"""What a file of keypoints holds, as its reader hands it on: in its own frame numbers, units and scores."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError, shown
from ..files.kinds import number_array
from .keypoints import SecondSource, no_face, no_hands
from .layouts import LAYOUTS, Layout, layout_of

MOST_PEOPLE = 100  # people of one frame; the performer among more is nobody's take
MOST_POINTS = 8 * 10**6  # points of all people in all frames of a file
FARTHEST_PX = 1e7  # of a coordinate from the origin; float32 counts single pixels up to there
FARTHEST_M = 100.0  # of a guessed point from the hips
BODY = "pose_keypoints_2d"  # OpenPose's list, without which a person is a hand or a face


@dataclass(frozen=True, eq=False)
class DetectedPerson:
    """One person in one frame, N points in the order of the layout; NaN where not seen."""

    place: Array  # (N, 2) coordinates, in pixels or shares of the picture
    score: Array  # (N,) the detector's own
    hint_m: Array | None = None  # (N, 3) as in `Keypoints`, where the detector guesses it
    body: int = 0  # number of the body's points, which hands follow; 0 where all are the body's
    face: Array = field(default_factory=no_face)  # (6,) as in `Keypoints`, NaN where not looked at
    hands: Array = field(default_factory=no_hands)  # (2, 22) likewise


@dataclass(frozen=True, eq=False)
class DetectedFrames:
    """Everyone in a file of keypoints."""

    where: str  # the file or folder, for sentences
    source: str  # the detector, or the file
    layout: Layout
    people: Mapping[int, Sequence[DetectedPerson]]  # those of each frame by its number, nobody included
    numbered: bool = False  # whether the numbers are the file's; else they count its entries
    complete: bool = True  # whether frames in which nobody was seen have a number too
    size: tuple[int, int] | None = None
    """Width and height of the pictures the detector saw [px]; None where the file does not say."""
    shares: bool = False
    """Whether places are shares of the picture's width and height, as MediaPipe writes them."""
    fps: float | None = None  # frames per second, where the file says
    time_s: Array | None = None  # (E,) times of the entries from the clip's first frame, where the file says
    frame_start: int | None = None  # scene frame of the first entry, where the file says
    by_hand: bool = False  # as in `People`
    second: SecondSource | None = None


@dataclass(eq=False)
class Everyone:
    """The people of a file's frames, checked as they are read: all must have the same points."""

    where: str
    layout: Layout | None = None
    people: dict[int, list[DetectedPerson]] = field(default_factory=dict)
    _points: int = 0  # of all of them
    _longest: int = 0  # points of the one who has most
    _bodiless: set[str] = field(default_factory=set)  # what those have who were left out

    def add(
        self, number: int, entries: Mapping[str, Any], read: Callable[[Any, str], DetectedPerson | None]
    ) -> None:
        """Add people of a frame, by their places in the file, as `read` makes them of entry and place."""
        found = self.people.setdefault(number, [])
        if len(found) + len(entries) > MOST_PEOPLE:
            count = len(found) + len(entries)
            raise InputError(
                f"{self.where}: frame {number} has {count} people; at most {MOST_PEOPLE} in a frame are read"
            )
        for at, entry in entries.items():
            person = read(entry, at)
            if person is None:
                self._bodiless.update(str(name) for name, own in entry.items() if own)
                continue
            count = person.body or len(person.place)
            self.layout = self.layout or layout_of(count)
            if self.layout is None:
                known = ", ".join(f"{layout.name} ({layout.count})" for layout in LAYOUTS.values())
                raise InputError(f"{at} has {count} points; layouts that are read have {known}")
            if self.layout.count != count:
                before = f"those before have {self.layout.count}"
                raise InputError(f"{at} has {count} points; {before}, and all must be alike")
            self._longest = max(self._longest, len(person.place))
            self._points += len(person.place)
            if self._points > MOST_POINTS:  # before more is read
                raise InputError(
                    f"{self.where}: has {self._points} points in all frames; at most {MOST_POINTS} are read"
                )
            found.append(person)

    def frames(self, source: str, stated_by: Sequence[Any] = (), **more: Any) -> DetectedFrames:
        """Everyone, with `more` fields; `stated_by` are entries that may state which frame each is of."""
        layout, people = self.layout, self.people
        if layout is None or not any(people.values()):
            why = f"nobody is seen in any of its {len(people)} frames; one must show a person"
            if self._bodiless:
                why = f"its people have {shown(sorted(self._bodiless))} and no {BODY}, which they must have"
            raise InputError(f"{self.where}: {why}")
        if self._longest > layout.count:
            layout = layout.with_hands
            people = {at: [_as_long(one, self._longest) for one in there] for at, there in people.items()}
        numbers, time_s = stated_frames(stated_by)
        if numbers is not None or time_s is not None:
            more |= {"numbered": numbers is not None, "complete": False, "time_s": time_s}
            people = dict(zip(people if numbers is None else numbers, people.values(), strict=True))
        return DetectedFrames(self.where, source, layout, people, **more)


def placed(items: Sequence[Any], spot: str) -> dict[str, Any]:
    """Items of a list by their places in it."""
    return {f"{spot}[{index}]": item for index, item in enumerate(items)}


def _as_long(person: DetectedPerson, points: int) -> DetectedPerson:
    """A person with so many points, of which those that are added are not seen."""
    added = (0, points - len(person.place))
    return DetectedPerson(np.pad(person.place, (added, (0, 0))), np.pad(person.score, added))


def person_array(value: Any, shape: tuple[int, ...], farthest: float, where: str) -> Array:
    """Nested lists of numbers as an array of a shape, in which -1 is any length; null becomes NaN."""
    array = number_array(value, nulls=True)
    fits = array is not None and len(shape) == array.ndim
    if not fits or array is None or any(n not in (-1, m) for n, m in zip(shape, array.shape, strict=True)):
        words = " x ".join("any number" if length < 0 else str(length) for length in shape)
        raise InputError(f"{where} is {shown(value)}; it must be a list of numbers of shape {words}")
    if np.nanmax(np.abs(array), initial=0.0) > farthest:
        raise InputError(f"{where} has a number beyond {farthest:g}; it must be a place in a picture")
    return array


# --- What the entries of a list say of themselves. Programs leave out frames without a person, or look at
# some frames only: where every entry carries its frame's number or its time, that is believed instead of its
# position.


NUMBERS = ("frame", "framenumber", "frameindex", "frameidx", "frameid", "framenum")
STAMPS = ("timestampms", "timems", "timestampus", "timestamp", "timestamps", "times", "timesec", "time")
"""Names of fields, without capitals and underscores, the surest first."""
MOST = 2.0**53
LONGEST_S = 1e6  # a later time is a time of day


def stated_frames(entries: Sequence[Any]) -> tuple[tuple[int, ...] | None, Array | None]:
    """The numbers of the frames that E entries are of, and their times (E,) [s], both ascending.

    None for what not all of them state, or where it counts something else than frames.
    """
    numbers, stamps = _stated(entries, NUMBERS), _stated(entries, STAMPS)
    if numbers is not None and (numbers != np.floor(numbers)).any():
        numbers = None
    if stamps is not None:
        step = float(np.median(np.diff(stamps))) if len(stamps) > 1 else 0.0
        # Between frames lie a millisecond to a second.
        stamps = stamps * (1.0 if step <= 1.0 else 1e-3 if step <= 1000.0 else 1e-6)
        stamps = stamps if 0.0 <= stamps[0] < LONGEST_S else None
    return None if numbers is None else tuple(int(number) for number in numbers), stamps


def _stated(entries: Sequence[Any], names: Sequence[str]) -> Array | None:
    """(E,) the numbers in the surest field that all entries have, if they ascend."""
    if not entries or not all(isinstance(entry, Mapping) for entry in entries):
        return None
    fields = {
        name.replace("_", "").replace(" ", "").replace("-", "").lower(): name
        for name in entries[0]
        if isinstance(name, str)
    }
    for name in names:
        values: list[Any] = [entry.get(fields[name]) for entry in entries] if name in fields else [None]
        if all(type(value) in (int, float) and abs(value) < MOST for value in values):
            numbers = np.array(values, dtype=np.float64)
            return numbers if (np.diff(numbers) > 0.0).all() else None
    return None
