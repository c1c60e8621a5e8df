"""The trunk between given legs and arms: hips, spine, neck and head along the bones of the middle."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..roles import MIDDLE
from .frame import Frame
from .likelihood import at_least, at_most, near
from .limbs import TEMPERATURE, part_scores

STATES = ("below", "hips", "spine", "neck", "head", "end")
"""What a bone of the path from the root to the top of the head may be, in this order."""
UNLIKELY = -6.0
NO_HEAD = -5.0
"""Score of a trunk without a head."""
SURE = 0.75
"""Probability from which a bone's part is not doubted."""
SAME_JOINT = 0.02
"""A bone this near above another, in heights of the trunk, begins where it does."""


@dataclass(frozen=True)
class Trunk:
    """Bones of the trunk, and how well they fit."""

    hips: int
    spine: tuple[int, ...]
    neck: tuple[int, ...]
    head: int | None
    score: float
    sure: Mapping[str, float]
    """By part how probable its least certain bone is."""
    doubtful: tuple[tuple[int, str, str], ...]
    """Bones of the path that may play another part: bone, the part it plays, and the other part."""


@dataclass(frozen=True, eq=False)
class Girdles:
    """Where legs and arms begin: joints in the frame's coordinates, and the bones of the middle above."""

    hip: Array
    """(3,)."""
    shoulder: Array
    """(3,)."""
    legs_on: int
    arms_on: int
    fork: int
    """The lowest bone that carries both legs and arms."""

    @property
    def height(self) -> float:
        """From hip joints to shoulder joints."""
        return max(float(self.shoulder[2] - self.hip[2]), 1e-6)


def fork_of(frame: Frame, first: int, second: int) -> int:
    """The lowest bone above two bones, or one of them; -1 where there is none."""
    if first < 0 or second < 0:
        return -1
    above = [first, *frame.bones.ancestors(first)]
    for bone in (second, *frame.bones.ancestors(second)):
        if bone in above:
            return bone
    return -1


def find_trunk(frame: Frame, girdles: Girdles) -> Trunk | None:
    """The likeliest trunk; None where no path leads from the legs up past the arms."""
    names = np.array([part_scores(frame, part) for part in MIDDLE])
    best: Trunk | None = None
    for top in _tops(frame, girdles):
        found = _along(frame, girdles, top, names)
        if found is not None and (best is None or found.score > best.score):
            best = found
    return best


def _tops(frame: Frame, girdles: Girdles) -> list[int]:
    """Ends of paths that may lead to the top of the head, or only to the arms."""
    bones = frame.bones
    height = frame.place[:, 2]
    ends = [
        bone
        for bone in bones.subtree[girdles.fork]
        if frame.middle[bone]
        and height[bone] > girdles.shoulder[2] - 0.3 * girdles.height
        and not any(frame.middle[child] and height[child] > height[bone] for child in bones.children[bone])
    ]
    ends.sort(key=lambda bone: -frame.place[bone, 2])
    return [*dict.fromkeys([*ends[:20], girdles.arms_on])]


def _along(frame: Frame, girdles: Girdles, top: int, names: Array) -> Trunk | None:
    """The best trunk along the path from the root to a bone."""
    path = [top, *frame.bones.ancestors(top)][::-1]
    scores = _emissions(frame, girdles, path, names)
    tops = _top_scores(frame, girdles, path)
    states, total = _best_states(scores, tops)
    if states is None:
        return None
    parts = {
        state: [bone for bone, own in zip(path, states, strict=True) if own == state] for state in STATES
    }
    shares = _shares(scores, tops)
    sure = {
        state: min(shares[row, STATES.index(state)] for row, own in enumerate(states) if own == state)
        for state in dict.fromkeys(states)
    }
    doubtful = _doubtful(path, states, shares)
    total += _way_up(frame, girdles, parts["head"])
    head = parts["head"][0] if parts["head"] else None
    spine = tuple(bone for bone in parts["spine"] if not frame.bones.readings[bone].mechanism)
    return Trunk(parts["hips"][0], spine, tuple(parts["neck"]), head, total, sure, doubtful)


def _way_up(frame: Frame, girdles: Girdles, head: list[int]) -> float:
    """How well a head lies above the shoulders."""
    if not head:
        return 0.0
    up = frame.place[head[0]] - girdles.shoulder
    return float(near(up[1] / girdles.height, 0.0, 0.25, 4.0) + at_least(up[2] / girdles.height, 0.1, 0.1))


def _emissions(frame: Frame, girdles: Girdles, path: list[int], names: Array) -> Array:
    """(K, 6) log-likelihood of each state for each bone of a path."""
    place, bones = frame.place, frame.bones
    carrying = [girdles.arms_on, *bones.ancestors(girdles.arms_on)]
    rank = path.index(girdles.fork)
    scores = np.zeros((len(path), len(STATES)))
    for row, bone in enumerate(path):
        level = (place[bone, 2] - girdles.hip[2]) / girdles.height
        over = level - 1.0
        carries = bone in carrying
        next_level = (
            (place[path[row + 1], 2] - girdles.hip[2]) / girdles.height if row + 1 < len(path) else None
        )
        faces = sum(frame.one_side[child] for child in bones.children[bone]) if not carries else 0
        hips, spine, neck, head = names[:, bone]
        off = float(np.linalg.norm((place[bone] - girdles.hip)[1:])) / girdles.height
        far = abs(row - rank)
        scores[row] = (
            (0.0 if row < rank else UNLIKELY) + min(-0.3 * max(hips, spine, neck, head), 0.0),
            hips
            + (0.0 if far == 0 else (-4.0 if row > rank else UNLIKELY))
            + float(near(off, 0.0, 0.4, 4.0)),
            spine + float(at_most(level, 0.98, 0.05, 5.0)) + (0.5 if carries else -1.5),
            neck
            + float(at_least(over, 0.0, 0.08, 5.0) + at_most(over, 0.35, 0.15))
            - (1.0 if carries else 0.0),
            head + float(near(over, 0.33, 0.2, 5.0)) + min(faces, 2) * 0.8 - (4.0 if carries else 0.0),
            (0.0 if row > rank else UNLIKELY) + min(-0.5 * max(neck, head), 0.0),
        )
        if row and float(np.linalg.norm(place[bone] - place[path[row - 1]])) < SAME_JOINT * girdles.height:
            scores[row, 3:5] -= 2.0  # the bone that carries it plays the part
        if next_level is not None:  # a head is longer than a neck bone
            scores[row, 3] += float(at_most(next_level - level, 0.3, 0.1, 3.0))
    return scores


def _top_scores(frame: Frame, girdles: Girdles, path: list[int]) -> Array:
    """(K,) log-likelihood that a bone of the path is the first above the head joint."""
    found = np.zeros(len(path))
    for row, bone in enumerate(path[1:], 1):
        over = (frame.place[bone, 2] - girdles.shoulder[2]) / girdles.height
        step = float(np.linalg.norm(frame.place[bone] - frame.place[path[row - 1]])) / girdles.height
        siblings = len(frame.bones.children[path[row - 1]]) - 1
        found[row] = max(
            float(at_least(over, 0.55, 0.15, 2.0)),
            -0.3 if step < SAME_JOINT else -2.0,
            -0.3 if siblings >= 2 or frame.bones.readings[bone].other else -2.0,
        )
    return found


def _best_states(scores: Array, tops: Array) -> tuple[list[str] | None, float]:
    """The likeliest states that never fall back, with one hips and at most one head.

    Returns:
        The states by bone, None where there is no way; their log-likelihood.
    """
    count = len(STATES)
    best = np.full(count, -np.inf)
    best[0], best[1] = scores[0, 0], scores[0, 1]
    back: list[list[int]] = []
    for row in range(1, len(scores)):
        step = np.full(count, -np.inf)
        came = [0] * count
        for state in range(count):
            for before in _before(state):
                gain = best[before] + scores[row, state] + _step(before, state, tops[row])
                if gain > step[state]:
                    step[state], came[state] = gain, before
        best = step
        back.append(came)
    best[0] = -np.inf
    best[1:4] += NO_HEAD
    state = int(np.argmax(best))
    total = float(best[state])
    if not np.isfinite(total):
        return None, total
    states = [state]
    for came in reversed(back):
        states.append(came[states[-1]])
    return [STATES[each] for each in reversed(states)], total


def _before(state: int) -> tuple[int, ...]:
    """States that may come before one."""
    return {0: (0,), 1: (0,), 2: (1, 2), 3: (1, 2, 3), 4: (1, 2, 3), 5: (4, 5)}[state]


def _shares(scores: Array, tops: Array) -> Array:
    """(K, 6) probability of each state of each bone, over all ways."""
    heat = 1.0 / TEMPERATURE
    forward = np.full(scores.shape, -np.inf)
    forward[0, :2] = heat * scores[0, :2]
    backward = np.full(scores.shape, -np.inf)
    backward[-1] = heat * np.array([-np.inf, NO_HEAD, NO_HEAD, NO_HEAD, 0.0, 0.0])
    for row in range(1, len(scores)):
        for state in range(len(STATES)):
            ways = [
                forward[row - 1, before] + heat * _step(before, state, tops[row]) for before in _before(state)
            ]
            forward[row, state] = heat * scores[row, state] + np.logaddexp.reduce(ways)
    for row in range(len(scores) - 2, -1, -1):
        for before in range(len(STATES)):
            ways = [
                backward[row + 1, state]
                + heat * (scores[row + 1, state] + _step(before, state, tops[row + 1]))
                for state in range(len(STATES))
                if before in _before(state)
            ]
            backward[row, before] = np.logaddexp.reduce(ways)
    both = forward + backward
    shares = np.exp(both - np.logaddexp.reduce(both, axis=1, keepdims=True))
    return np.asarray(shares)


def _step(before: int, state: int, top: float) -> float:
    return top if (before, state) == (4, 5) else 0.0


def _doubtful(path: list[int], states: list[str], shares: Array) -> tuple[tuple[int, str, str], ...]:
    """Bones of the path that may well play another part."""
    found = []
    for row, (bone, state) in enumerate(zip(path, states, strict=True)):
        others = shares[row].copy()
        others[STATES.index(state)] = 0.0
        if shares[row, STATES.index(state)] < SURE:
            found.append((bone, state, STATES[int(np.argmax(others))]))
    return tuple(found)
