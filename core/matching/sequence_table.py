"""Tables of a library's sequences, interpolated at any time: marker moments, height, travel, postures."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IndexArray
from ..body.heading import yaw_rotation, yawed_at
from ..body.posture import Posture
from .marker_moments import MarkerMoments
from .posture_sequences import PostureSequences


@dataclass(frozen=True, eq=False)
class SequenceSamples:
    """Samples of sequences at T times, in the axes of a motion that heads straight ahead at its beginning."""

    centroid: Array
    """(T, M, 3) of the markers, relative to the hips [m]."""
    second_moment: Array
    """(T, M, 3, 3) of the markers [m²]."""
    hip_height_m: Array
    """(T,) height of the hips [m]."""
    travel: Array
    """(T, 3) travel of the hips since the sequence's time 0 [m]."""


@dataclass(frozen=True, eq=False)
class SequenceTable:
    """All sequences at their steps of time; a cycle's first posture comes once more at its end."""

    sequences: PostureSequences
    moments: MarkerMoments

    @cached_property
    def _rows(self) -> tuple[IndexArray, IndexArray]:
        """Index of each row's posture, and each sequence's first row."""
        rows, starts = [], [0]
        for first, sequence in zip(self.sequences.starts, self.sequences.sequences, strict=False):
            own = first + np.arange(len(sequence))
            rows.append(np.append(own, first) if sequence.cyclic else own)
            starts.append(starts[-1] + len(rows[-1]))
        return np.concatenate(rows), np.array(starts)

    @cached_property
    def _moments(self) -> tuple[Array, Array, Array]:
        """Centroids, second moments and travels (R, 3) of all rows; a cycle's last row has its turn."""
        rows, starts = self._rows
        centroid, second_moment = self.moments.centroid[rows], self.moments.second_moment[rows]
        travel = np.zeros((len(rows), 3))
        for index, sequence in enumerate(self.sequences.sequences):
            own = slice(starts[index], starts[index + 1])
            count = len(sequence)
            ground_path_m = (
                sequence.ground_path_m[count : 2 * count + 1] if sequence.cyclic else sequence.ground_path_m
            )
            travel[own, :2] = ground_path_m - ground_path_m[0]
            travel[own, 2] = self.moments.hip_height_m[rows[own]] - self.moments.hip_height_m[rows[own.start]]
            if sequence.cyclic:
                turn = yaw_rotation(np.array(sequence.turn_rad))
                centroid[own.stop - 1] = centroid[own.stop - 1] @ turn.T
                second_moment[own.stop - 1] = turn @ second_moment[own.stop - 1] @ turn.T
        return centroid, second_moment, travel

    def _bracket(
        self, sequence: IndexArray, time_s: Array
    ) -> tuple[IndexArray, IndexArray, Array, IndexArray]:
        """(T,) rows before and after some times, the share between them, and the cycle."""
        _, starts = self._rows
        step = np.array([entry.step_s for entry in self.sequences.sequences])[sequence]
        position = np.where(step > 0.0, time_s / np.where(step > 0.0, step, 1.0), 0.0)
        last = (np.diff(starts) - 1)[sequence]
        cyclic = np.array([entry.cyclic for entry in self.sequences.sequences])[sequence]
        cycle = np.where(cyclic, np.floor(position / np.maximum(last, 1)), 0.0)
        local = np.clip(position - cycle * last, 0.0, last)
        low = np.minimum(local.astype(np.intp), np.maximum(last - 1, 0))
        first = starts[:-1][sequence] + low
        second = np.minimum(first + 1, starts[1:][sequence] - 1)
        return first, second, local - low, cycle.astype(np.intp)

    def sample(self, sequence: IndexArray, time_s: Array) -> SequenceSamples:
        """Interpolate sequences at some times; before its beginning and after its end a sequence rests."""
        rows, _ = self._rows
        centroids, second_moments, travels = self._moments
        first, second, share, cycle = self._bracket(sequence, time_s)

        def between(values: Array) -> Array:
            weight = share.reshape(-1, *[1] * (values.ndim - 1))
            return np.asarray((1.0 - weight) * values[first] + weight * values[second])

        turn = self._turn(sequence, cycle)
        centroid = between(centroids) @ np.swapaxes(turn, -1, -2)
        second_moment = turn[:, None] @ between(second_moments) @ np.swapaxes(turn, -1, -2)[:, None]
        travel = self._over_cycles(between(travels), sequence, cycle)
        return SequenceSamples(centroid, second_moment, between(self.moments.hip_height_m[rows]), travel)

    def points(self, sequence: IndexArray, time_s: Array) -> Array:
        """(T, P, 3) the body's points at some times, relative to the hips [m], in the axes of `sample`."""
        rows, starts = self._rows
        points = self.moments.points[rows]
        for index, entry in enumerate(self.sequences.sequences):
            points[starts[index + 1] - 1] = (
                points[starts[index + 1] - 1] @ yaw_rotation(np.array(entry.turn_rad)).T
            )
        first, second, share, cycle = self._bracket(sequence, time_s)
        weight = share[:, None, None]
        between = (1.0 - weight) * points[first] + weight * points[second]
        return np.asarray(between @ np.swapaxes(self._turn(sequence, cycle), -1, -2))

    def posture(self, sequence: IndexArray, time_s: Array, heading_rad: Array, hips: Array) -> Posture:
        """(T,) postures at some times, with headings of the motion's beginning and places of the hips [m]."""
        rows, starts = self._rows
        first, second, share, cycle = self._bracket(sequence, time_s)
        ends = np.zeros(len(rows))
        ends[starts[1:] - 1] = [entry.turn_rad for entry in self.sequences.sequences]
        postures = yawed_at(self.sequences.posture[rows], ends, np.zeros((len(rows), 3)))
        led = postures[first].plus(share[:, None] * postures[second].minus(postures[first]))
        turned = np.array([entry.turn_rad for entry in self.sequences.sequences])[sequence]
        return yawed_at(led, heading_rad + cycle * turned, hips)

    def nearest(self, sequence: IndexArray, time_s: Array) -> IndexArray:
        """(T,) index of the nearest in time of all the sequences' postures."""
        first, second, share, _ = self._bracket(sequence, time_s)
        return self._rows[0][np.where(share < 0.5, first, second)]

    def _turn(self, sequence: IndexArray, cycle: IndexArray) -> Array:
        return yaw_rotation(
            cycle * np.array([entry.turn_rad for entry in self.sequences.sequences])[sequence]
        )

    def _over_cycles(self, travel: Array, sequence: IndexArray, cycle: IndexArray) -> Array:
        """Travel (T, 3) some cycles later."""
        _, starts = self._rows
        ends = self._moments[2][starts[1:] - 1]  # (C, 3)
        turns = np.array([entry.turn_rad for entry in self.sequences.sequences])
        carried = np.array(travel)
        for index in np.unique(sequence[cycle != 0]):
            turn = yaw_rotation(turns[index])
            own = (sequence == index) & (cycle != 0)
            for count in np.unique(cycle[own]):
                rows = own & (cycle == count)
                moved = carried[rows]
                for _ in range(abs(int(count))):
                    moved = moved @ turn.T + ends[index] if count > 0 else (moved - ends[index]) @ turn
                carried[rows] = moved
        return carried
