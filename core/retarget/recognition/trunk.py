"""The trunk between given legs and arms: hips, spine, neck and head along the bones of the middle."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, IndexArray
from ..roles import MIDDLE
from .frame import Frame
from .likelihood import at_least, at_most, near
from .limbs import TEMPERATURE, part_scores
from .trunk_sequence import HEAD, STATES, likeliest_states, state_probabilities

UNLIKELY = -6.0
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
    best: tuple[float, list[int], Array, Array, IndexArray] | None = None
    for top in _tops(frame, girdles):
        path = [top, *frame.bones.ancestors(top)][::-1]
        scores = _emissions(frame, girdles, path, names)
        tops = _top_scores(frame, girdles, path)
        states, total = likeliest_states(scores, tops)
        total += _way_up(
            frame, girdles, [bone for bone, own in zip(path, states, strict=True) if own == HEAD]
        )
        if np.isfinite(total) and (best is None or total > best[0]):
            best = total, path, scores, tops, states
    return None if best is None else _trunk(frame, *best)


def _trunk(
    frame: Frame, total: float, path: list[int], scores: Array, tops: Array, states: IndexArray
) -> Trunk:
    """The trunk of a sequence of states, and how sure they are."""
    shares = state_probabilities(scores / TEMPERATURE, tops / TEMPERATURE)
    own = shares[np.arange(len(path)), states]
    parts: dict[str, list[int]] = {state: [] for state in STATES}
    sure: dict[str, float] = {}
    doubtful = []
    for row, bone in enumerate(path):
        state = STATES[states[row]]
        parts[state].append(bone)
        sure[state] = min(float(own[row]), sure.get(state, 1.0))
        if own[row] < SURE:
            others = np.where(np.arange(len(STATES)) == states[row], 0.0, shares[row])
            doubtful.append((bone, state, STATES[int(np.argmax(others))]))
    head = parts["head"][0] if parts["head"] else None
    spine = tuple(bone for bone in parts["spine"] if not frame.bones.readings[bone].mechanism)
    return Trunk(parts["hips"][0], spine, tuple(parts["neck"]), head, total, sure, tuple(doubtful))


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
            scores[row, 3:5] -= 4.0  # the bone that carries it plays the part
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
