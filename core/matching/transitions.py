"""Transition probabilities: on in the motion at a usual speed, turning a little, traveling along."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array, IndexArray, Int32Array, SingleArray
from .emissions import FrameEmissions
from .frame_likelihood import FrameLikelihood
from .posture_sequences import PostureSequences

SLOWEST, FASTEST = 0.4, 2.5
"""Bounds of the speed, relative to the typical one."""
SPEED_STD = 0.45
"""Standard deviation of the speed's logarithm."""
STAY_PROBABILITY = 0.05
"""Probability of holding still."""
MEAN_TURN_RATE, LARGEST_TURN_RATE = 0.4, 6.0
"""Turning besides the motion's own [rad/s]: on average, as people mostly face one way, and at most."""
TURN_DECAY = 0.3
"""Ratio of the probabilities of turning by one heading more and not."""
DRIFT_STD_M = 0.35
"""Standard deviation of the place besides the motion's travel, in a second."""
DRIFT_CAP = np.float32(12.0)
"""Largest cost of a drift, for places that the footage gives wrongly."""
LEAST_PROBABILITY = 1e-3
"""Steps less probable are left out."""


@dataclass(frozen=True, eq=False)
class Shift:
    """Transition of all N H states by a number of postures and of headings."""

    origin: Int32Array
    """(N H,) the state each is reached from; N H for none."""
    travel: SingleArray
    """(2, N H) the motion's travel on the way [m], in the world."""


@dataclass(frozen=True, eq=False)
class Shifts:
    """Shifts between the states of some sequences in H headings, each built once."""

    sequences: PostureSequences
    heading_rad: Array
    _cache: dict[tuple[int, int], Shift] = field(default_factory=dict)

    def shift(self, steps: int, turn_bins: int) -> Shift:
        """The shift by a number of postures and of headings."""
        key = steps, turn_bins
        if key not in self._cache:
            self._cache[key] = self._build(steps, turn_bins)
        return self._cache[key]

    def _build(self, steps: int, turn_bins: int) -> Shift:
        count = len(self.heading_rad)
        total = len(self.sequences) * count
        before, travel_back, turn_back = self.sequences.advance(-steps)
        columns = np.arange(count)
        bins = count / (2.0 * np.pi)

        def states(posture: IndexArray, turn: Array, offset: int) -> Int32Array:
            aim = np.rint(turn * bins).astype(int)[:, None] + offset
            state = posture[:, None] * count + (columns + aim) % count
            return np.where(posture[:, None] < 0, total, state).ravel().astype(np.int32)

        origin = states(before, turn_back, -turn_bins)
        # The travel back is in the axes of the target state; reversed it is the travel there.
        c, s = np.cos(self.heading_rad), np.sin(self.heading_rad)
        x, y = -travel_back[:, 0, None], -travel_back[:, 1, None]
        travel = np.stack([c * x - s * y, s * x + c * y]).reshape(2, -1)
        return Shift(origin, travel.astype(np.float32))

    def step_probabilities(self, duration_s: float) -> Array:
        """(A, N) probability of going on by 0, 1, ... A - 1 postures in a time, per posture."""
        log_speed = np.linspace(np.log(SLOWEST), np.log(FASTEST), 25)
        share = np.exp(-0.5 * (log_speed / SPEED_STD) ** 2)
        share /= share.sum()
        step = np.where(self.sequences.step_s > 0.0, self.sequences.step_s, np.inf)
        expected_steps = duration_s / step * np.exp(log_speed)[:, None]  # (25, N) postures
        most = int(np.ceil(expected_steps.max())) + 1
        amounts = np.arange(most)[:, None, None]
        probability = (share[:, None] * np.maximum(0.0, 1.0 - np.abs(expected_steps - amounts))).sum(axis=1)
        probability *= 1.0 - STAY_PROBABILITY
        probability[0] += STAY_PROBABILITY
        return np.asarray(probability)

    def turn_log_probabilities(self, duration_s: float) -> dict[int, float]:
        """Log probability of turning by each number of headings in a time."""
        bin_rad = 2.0 * np.pi / len(self.heading_rad)
        reach = int(np.clip(np.ceil(LARGEST_TURN_RATE * duration_s / bin_rad), 1, 3))
        turning = MEAN_TURN_RATE * duration_s / bin_rad  # headings passed, on average
        share = 1.0 - np.exp(-turning)
        probability = {k: 0.5 * share * TURN_DECAY ** (k - 1) for k in range(1, reach + 1)}
        left = 1.0 - 2.0 * sum(probability.values())
        return {k: float(np.log(probability[abs(k)] if k else left)) for k in range(-reach, reach + 1)}


@dataclass(frozen=True, eq=False)
class Transition:
    """One shift between two frames, for the states that it reaches."""

    origin: Int32Array
    """(R,) indices among the earlier frame's states."""
    target: Int32Array
    """(R,) indices among the later frame's."""
    weight: SingleArray
    """(R,) log probability."""


def frame_transitions(
    shifts: Shifts,
    duration_s: float,
    likelihoods: tuple[FrameLikelihood, FrameLikelihood],
    emissions: tuple[FrameEmissions, FrameEmissions],
) -> list[Transition]:
    """Transitions from the states of one frame to those of the next.

    Args:
        shifts: Shifts between all states.
        duration_s: Time between the frames.
        likelihoods: Of both frames.
        emissions: Of both frames.
    """
    whiten = _whitening(likelihoods, duration_s)
    first, second = whiten @ emissions[0].ground, whiten @ emissions[1].ground
    states = emissions[1].states
    headings = len(shifts.heading_rad)
    row_of = np.full(len(shifts.sequences) * headings + 1, -1, dtype=np.int32)
    row_of[emissions[0].states] = np.arange(len(emissions[0].states))
    step_probability = shifts.step_probabilities(duration_s)
    with np.errstate(divide="ignore"):
        log_step_probability = np.log(step_probability).astype(np.float32)
    found = []
    for steps in range(len(step_probability)):
        for turn_bins, log_share in shifts.turn_log_probabilities(duration_s).items():
            shift = shifts.shift(steps, turn_bins)
            origin = row_of[shift.origin[states]]
            target = np.flatnonzero(
                (origin >= 0) & (step_probability[steps][states // headings] > LEAST_PROBABILITY)
            )
            if not len(target):
                continue
            origin, own = origin[target], states[target]
            apart = second[:, target] - first[:, origin] - whiten[:, :2] @ shift.travel[:, own]
            apart *= apart
            drift = np.minimum(np.float32(0.5) * apart.sum(axis=0), DRIFT_CAP)
            weight = log_step_probability[steps][own // headings] + np.float32(log_share) - drift
            found.append(Transition(origin, target.astype(np.int32), weight))
    return found


def _whitening(likelihoods: tuple[FrameLikelihood, FrameLikelihood], duration_s: float) -> SingleArray:
    """(3, 3) whitens differences of places [m].

    What a frame leaves undetermined of the place, mostly along the line of sight, may change between frames.
    """
    uncertainty = sum(np.linalg.inv(likelihood.information) for likelihood in likelihoods)
    covariance = uncertainty + (DRIFT_STD_M * np.sqrt(duration_s * max(duration_s, 0.1))) ** 2 * np.eye(3)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(covariance)), dtype=np.float32)
