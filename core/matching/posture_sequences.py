"""A library's motions as sequences of postures at small steps of time, on the body of the take.

A motion becomes a *sequence* of postures so close that those between two neighbors are well known; so does
its mirror image, where that is another motion. A posture in no motion is a sequence of its own.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import UP
from ..body.kinematics import Body
from ..body.mirror import mirrored
from ..body.posture import Posture
from ..library.library import Library, LibraryMotion
from ..library.motion_playback import sample_motion
from ..library.transfer import transferred

STEP_M = 0.045
"""Mean distance of the points from one posture to the next: well below what performers differ by."""
LEAST_RATE, MOST_RATE = 8.0, 25.0
"""Postures per second of a motion."""
MOST_POSTURES = 450
"""Postures of a whole library; with more the steps are widened."""
TRAVEL_M = 0.3
"""A cycle that travels farther is also tried on the spot, as on a treadmill."""
SAME_M = 0.03
"""A mirror image whose points come this near to its motion's, half a cycle on, is the same motion."""
MOST_SHIFTS = 100
"""Times of a cycle at which its mirror image is compared with it."""


@dataclass(frozen=True, eq=False)
class PostureSequence:
    """One motion at equal steps of time."""

    posture: Posture
    """(N,) with the floor at z = 0 and the motion's travel in x and y."""
    names: tuple[str, ...]
    """N names of the library's postures nearest in time."""
    mirrored: bool
    step_s: float
    """Time from each posture to the next; 0 for a single posture."""
    cyclic: bool
    ground_path_m: Array
    """(3 N, 2) the hips' place [m] in the cycle before, this one and the next; (N, 2) without cycles."""
    turn_rad: float
    """Change of the heading in a cycle."""
    motion: str
    """The motion's name; empty for a posture in no motion."""

    def __len__(self) -> int:
        """Number of postures."""
        return len(self.names)


@dataclass(frozen=True, eq=False)
class PostureSequences:
    """All sequences of a library, their N postures one after the other."""

    library: Library
    body: Body
    sequences: tuple[PostureSequence, ...]
    starts: IndexArray = field(init=False)
    """(C + 1,) index of each sequence's first posture."""

    def __post_init__(self) -> None:
        """Count the postures."""
        object.__setattr__(self, "starts", np.cumsum([0, *(len(sequence) for sequence in self.sequences)]))

    def __len__(self) -> int:
        """Number of postures N."""
        return int(self.starts[-1])

    @cached_property
    def posture(self) -> Posture:
        """(N,) all postures."""
        return Posture.concatenate([sequence.posture for sequence in self.sequences])

    @cached_property
    def sequence_of(self) -> IndexArray:
        """(N,) index of each posture's sequence."""
        return np.repeat(np.arange(len(self.sequences)), np.diff(self.starts))

    @cached_property
    def step_s(self) -> Array:
        """(N,) time from each posture to the next of its sequence."""
        return np.array([sequence.step_s for sequence in self.sequences])[self.sequence_of]

    def name(self, index: int) -> str:
        """Name of the library's posture nearest to one of the N."""
        sequence = int(self.sequence_of[index])
        return self.sequences[sequence].names[index - int(self.starts[sequence])]

    def is_mirrored(self, index: int) -> bool:
        """Whether left and right are exchanged in one of the N."""
        return self.sequences[int(self.sequence_of[index])].mirrored

    def advance(self, steps: int) -> tuple[IndexArray, Array, Array]:
        """The postures some steps later.

        Args:
            steps: Postures to go on by, at most a cycle; negative ones go back.

        Returns:
            (N,) index of the posture so many steps later, -1 where the sequence has ended; (N, 2) the travel
            there [m], in the axes of the motion; (N,) the change of the heading of these axes, where a new
            cycle has begun [rad].
        """
        index = np.full(len(self), -1, dtype=np.intp)
        travel, turn = np.zeros((len(self), 2)), np.zeros(len(self))
        for first, sequence in zip(self.starts, self.sequences, strict=False):
            count = len(sequence)
            own = np.arange(count)
            if not sequence.cyclic:
                own = own[(own + steps >= 0) & (own + steps < count)]
            index[first + own] = first + (own + steps) % count
            if sequence.cyclic and abs(steps) <= count:
                travel[first + own] = (
                    sequence.ground_path_m[count + own + steps] - sequence.ground_path_m[count + own]
                )
                turn[first + own] = (own + steps) // count * sequence.turn_rad
            elif not sequence.cyclic:
                travel[first + own] = sequence.ground_path_m[own + steps] - sequence.ground_path_m[own]
        return index, travel, turn


def library_sequences(library: Library, body: Body) -> PostureSequences:
    """All sequences of a library on the body of a take."""
    spacing = 1.0
    sequences = tuple(_sequences(library, body, spacing))
    total = sum(len(sequence) for sequence in sequences)
    if total > MOST_POSTURES:
        sequences = tuple(_sequences(library, body, total / MOST_POSTURES))
    return PostureSequences(library, body, sequences)


def _sequences(library: Library, body: Body, spacing: float) -> Iterator[PostureSequence]:
    used = {step.posture for motion in library.motions for step in motion.steps}
    for motion in library.motions:
        sequence = _sequence(library, motion, body, spacing)
        mirror_image = _mirrored(sequence)
        for each in (
            (sequence,) if _is_same_motion(sequence, mirror_image, body) else (sequence, mirror_image)
        ):
            yield each
            if (
                each.cyclic
                and np.linalg.norm(each.ground_path_m[len(each)] - each.ground_path_m[0]) > TRAVEL_M
            ):
                yield replace(each, ground_path_m=np.zeros_like(each.ground_path_m))
    for loose in library.postures:
        if loose.name in used:
            continue
        posture = Posture.stack([transferred(loose, library.actor, body)])
        single = PostureSequence(posture, (loose.name,), False, 0.0, False, np.zeros((1, 2)), 0.0, "")
        yield single
        mirror_image = _mirrored(single)
        if not _is_same_motion(single, mirror_image, body):
            yield mirror_image


def _sequence(library: Library, motion: LibraryMotion, body: Body, spacing: float) -> PostureSequence:
    """A motion at steps of time in which its points move about `STEP_M` times `spacing`."""
    whole = motion.duration_s if motion.cyclic else motion.steps[-1].time_s
    fine = np.linspace(0.0, whole, int(np.clip(np.ceil(whole * MOST_RATE) + 1, 3, MOST_POSTURES)))
    posture = sample_motion(library, motion, body, fine)
    points = body.points(body.pose(posture)) - posture.translation[:, None]
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(axis=1).sum())
    rate = np.clip(length / STEP_M / max(whole, 1e-6), LEAST_RATE, MOST_RATE) / spacing
    count = int(np.clip(np.ceil(whole * rate), 3, MOST_POSTURES))
    step = whole / count if motion.cyclic else whole / (count - 1)
    time = step * np.arange(count)
    times = np.array([entry.time_s for entry in motion.steps])
    away = np.abs(time[:, None] - times)
    if motion.cyclic:
        away = np.minimum(away, whole - away)
    names = tuple(motion.steps[int(i)].posture for i in away.argmin(axis=1))
    sampled = sample_motion(library, motion, body, time)
    ground_path_m = sampled.translation[:, :2]
    if motion.cyclic:
        around = step * np.arange(-count, 2 * count)
        ground_path_m = sample_motion(library, motion, body, around).translation[:, :2]
    turn = motion.travel[2] if motion.cyclic else 0.0
    return PostureSequence(sampled, names, False, step, motion.cyclic, ground_path_m, turn, motion.name)


def _mirrored(sequence: PostureSequence) -> PostureSequence:
    ground_path_m = sequence.ground_path_m * np.array([-1.0, 1.0])
    posture = mirrored(sequence.posture)
    return PostureSequence(
        posture,
        sequence.names,
        True,
        sequence.step_s,
        sequence.cyclic,
        ground_path_m,
        -sequence.turn_rad,
        sequence.motion,
    )


def _is_same_motion(sequence: PostureSequence, mirror_image: PostureSequence, body: Body) -> bool:
    """Whether a mirror image equals its motion, at the same or, in a cycle, at another time."""
    first, second = (_shape(entry.posture, body) for entry in (sequence, mirror_image))
    shifts = range(0, len(sequence), -(-len(sequence) // MOST_SHIFTS)) if sequence.cyclic else (0,)
    apart = [np.linalg.norm(np.roll(second, shift, axis=0) - first, axis=-1).mean() for shift in shifts]
    return float(min(apart)) < SAME_M


def _shape(posture: Posture, body: Body) -> Array:
    """(N, P, 3) points relative to the hips, which keep their height."""
    return np.asarray(body.points(body.pose(posture)) - posture.translation[:, None] * (1.0 - UP))
