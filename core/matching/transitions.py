"""How one state may follow another: on in its motion at a usual speed, turning a little, travelling along."""

from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array, IndexArray, Int32Array, SingleArray
from .emissions import Fit
from .frame_likelihood import Sight
from .posture_sequences import Chains

SLOWEST, FASTEST = 0.4, 2.5
"""Of the typical speed."""
SPEED_STD = 0.45
"""Of the logarithm of the speed."""
STAY = 0.05
"""Probability of holding still."""
TURNING, MOST_TURN = 0.4, 6.0
"""Turning besides what the motion turns [rad/s]: on average, as people mostly face one way, and at most."""
SHARPER = 0.3
"""Each heading farther aside at once is so much less probable."""
DRIFT_STD_M = 0.35
"""Going besides what the motion travels, in a second."""
DRIFT_CAP = np.float32(12.0)
"""A place that the footage gives wrongly costs no more than this."""
LEAST_PACE = 1e-3
"""Paces less probable than that are left out."""


@dataclass(frozen=True, eq=False)
class Road:
    """One way on for all N H states: so many postures further, so many headings aside."""

    origin: Int32Array
    """(N H,) the state each is reached from; N H where there is none."""
    way: SingleArray
    """(2, N H) how the motion travels on it [m], in the world."""


@dataclass(frozen=True, eq=False)
class Roads:
    """All ways between the states of some chains in H headings."""

    chains: Chains
    heading_rad: Array
    _known: dict[tuple[int, int], Road] = field(default_factory=dict)

    def road(self, steps: int, aside: int) -> Road:
        """The way on by so many postures and headings."""
        key = steps, aside
        if key not in self._known:
            self._known[key] = self._road(steps, aside)
        return self._known[key]

    def _road(self, steps: int, aside: int) -> Road:
        count = len(self.heading_rad)
        total = len(self.chains) * count
        before, back_way, back_turn = self.chains.advanced(-steps)
        columns = np.arange(count)
        bins = count / (2.0 * np.pi)

        def states(posture: IndexArray, turned: Array, offset: int) -> Int32Array:
            aim = np.rint(turned * bins).astype(int)[:, None] + offset
            state = posture[:, None] * count + (columns + aim) % count
            return np.where(posture[:, None] < 0, total, state).ravel().astype(np.int32)

        origin = states(before, back_turn, -aside)
        # The way back is told in the axes of the state that is come to: turned about it is the way there.
        c, s = np.cos(self.heading_rad), np.sin(self.heading_rad)
        x, y = -back_way[:, 0, None], -back_way[:, 1, None]
        way = np.stack([c * x - s * y, s * x + c * y]).reshape(2, -1)
        return Road(origin, way.astype(np.float32))

    def pace(self, duration_s: float) -> Array:
        """(A, N) probability of going on by 0, 1, ... A - 1 postures in a time."""
        log_speed = np.linspace(np.log(SLOWEST), np.log(FASTEST), 25)
        share = np.exp(-0.5 * (log_speed / SPEED_STD) ** 2)
        share /= share.sum()
        step = np.where(self.chains.step_s > 0.0, self.chains.step_s, np.inf)
        going = duration_s / step * np.exp(log_speed)[:, None]  # (25, N) postures
        most = int(np.ceil(going.max())) + 1
        amounts = np.arange(most)[:, None, None]
        pace = (share[:, None] * np.maximum(0.0, 1.0 - np.abs(going - amounts))).sum(axis=1)
        pace *= 1.0 - STAY
        pace[0] += STAY
        return np.asarray(pace)

    def asides(self, duration_s: float) -> dict[int, float]:
        """Logarithm of the probability of so many headings aside, in a time."""
        bin_rad = 2.0 * np.pi / len(self.heading_rad)
        reach = int(np.clip(np.ceil(MOST_TURN * duration_s / bin_rad), 1, 3))
        turning = TURNING * duration_s / bin_rad  # headings passed, on average
        share = 1.0 - np.exp(-turning)
        aside = {k: 0.5 * share * SHARPER ** (k - 1) for k in range(1, reach + 1)}
        left = 1.0 - 2.0 * sum(aside.values())
        return {k: float(np.log(aside[abs(k)] if k else left)) for k in range(-reach, reach + 1)}


@dataclass(frozen=True, eq=False)
class Move:
    """One way on, for the states of a frame that can be come to by it."""

    origin: Int32Array
    """(R,) which of the earlier frame's states."""
    target: Int32Array
    """(R,) which of the later frame's."""
    weight: SingleArray
    """(R,) logarithm of the probability."""


def moves(roads: Roads, duration_s: float, sights: tuple[Sight, Sight], fits: tuple[Fit, Fit]) -> list[Move]:
    """All ways from the states of a frame to those of the next.

    Args:
        roads: The ways.
        duration_s: Time between the frames.
        sights: What both frames say.
        fits: Their states.
    """
    whiten = _whitening(sights, duration_s)
    first, second = whiten @ fits[0].ground, whiten @ fits[1].ground
    states = fits[1].states
    headings = len(roads.heading_rad)
    place = np.full(len(roads.chains) * headings + 1, -1, dtype=np.int32)
    place[fits[0].states] = np.arange(len(fits[0].states))
    pace = roads.pace(duration_s)
    with np.errstate(divide="ignore"):
        log_pace = np.log(pace).astype(np.float32)
    found = []
    for steps in range(len(pace)):
        for aside, log_share in roads.asides(duration_s).items():
            road = roads.road(steps, aside)
            origin = place[road.origin[states]]
            target = np.flatnonzero((origin >= 0) & (pace[steps][states // headings] > LEAST_PACE))
            if not len(target):
                continue
            origin, own = origin[target], states[target]
            apart = second[:, target] - first[:, origin] - whiten[:, :2] @ road.way[:, own]
            apart *= apart
            drift = np.minimum(np.float32(0.5) * apart.sum(axis=0), DRIFT_CAP)
            weight = log_pace[steps][own // headings] + np.float32(log_share) - drift
            found.append(Move(origin, target.astype(np.int32), weight))
    return found


def _whitening(sights: tuple[Sight, Sight], duration_s: float) -> SingleArray:
    """(3, 3) takes differences of places [m] to standard deviations.

    What a frame leaves open of the place, mostly along the line of sight, may change from frame to frame.
    """
    open_to = sum(np.linalg.inv(sight.information) for sight in sights)
    covariance = open_to + (DRIFT_STD_M * np.sqrt(duration_s * max(duration_s, 0.1))) ** 2 * np.eye(3)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(covariance)), dtype=np.float32)
