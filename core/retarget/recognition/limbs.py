"""How well chains of bones fit a leg and an arm, by place and by name."""

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array, IndexArray
from ..roles import ARM, LEG
from .chains import Chains
from .frame import Frame
from .likelihood import at_least, at_most, near

NAMES_WEIGHT = 1.3
"""Names are trusted so much more than a measure of place."""
NO_END = -3.0
"""Score of an arm without a hand."""
NO_TOE, NO_SHOULDER = -4.0, -4.0
"""Scores of a foot without a toe and an upper arm without a collar bone, though bones are there."""
SHORT_LEG = 0.4
"""Length of a leg, in sizes, below which feet do not become smaller with it."""
TEMPERATURE = 1.0
"""Log-likelihoods are divided by this before they are turned into probabilities: measures hang together."""
MANY = 150
"""Best limbs of a kind by what is quickly measured; only these are looked at closely."""
FEW = 40
"""Best limbs of a kind that are weighed against each other."""


@dataclass(frozen=True)
class OptionalPart:
    """The bone of a part that a limb may lack."""

    bone: int
    """-1 for none."""
    probability: float
    rival: int
    """The next likely; -1 for none."""


@dataclass(frozen=True, eq=False)
class Limbs:
    """Chains that may be limbs of one kind, the best first."""

    chains: Chains
    score: Array
    """(C,) log-likelihood of each."""
    optional: tuple[OptionalPart, ...] = field(default=())
    """The toe of each leg, the shoulder of each arm."""


def part_scores(frame: Frame, part: str) -> Array:
    """(N,) what the names say of a part, both sides' names taken together."""
    bones, partner = frame.bones, frame.symmetry.partner
    own = np.array([reading.scores[part] for reading in bones.readings])
    other = np.where(partner >= 0, own[np.maximum(partner, 0)], own)
    return np.asarray(NAMES_WEIGHT * 0.5 * (own + other))


def quick_fit(frame: Frame, chains: Chains) -> float:
    """How well the best leg and the best arm fit by what is quickly measured."""
    return float(np.max(_leg_scores(frame, chains)) + np.max(_arm_scores(frame, chains)))


def find_legs(frame: Frame, chains: Chains) -> Limbs:
    """The likeliest legs."""
    score = _leg_scores(frame, chains)
    many = _best(score, MANY)
    chains = chains.taken(many)
    unit = np.array([foot_unit(_reach(frame, bones)) for bones in chains.bones])
    score = score[many] + _foot_scores(frame, chains, unit) + _line_scores(frame, chains)
    score += _below_hip_scores(frame, chains) + _strand_scores(frame, chains)
    best = _best(score, FEW)
    return _with_toes(frame, Limbs(chains.taken(best), score[best]))


def find_arms(frame: Frame, chains: Chains) -> Limbs:
    """The likeliest arms."""
    score = _arm_scores(frame, chains)
    many = _best(score, MANY)
    chains = chains.taken(many)
    score = score[many] + _hand_scores(frame, chains) + _line_scores(frame, chains)
    score += _strand_scores(frame, chains)
    best = _best(score, FEW)
    return _with_shoulders(frame, Limbs(chains.taken(best), score[best]))


def _leg_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) how well chains fit a leg by the places and names of their three bones."""
    hip, knee, ankle = (frame.place[chains.bones[:, part]] for part in range(3))
    upper, lower = _length(knee - hip), _length(ankle - knee)
    length = np.maximum(upper + lower, 1e-9)
    unit = np.maximum(length, SHORT_LEG)
    score = near(upper / length, 0.5, 0.06)
    score += at_least((hip[:, 2] - ankle[:, 2]) / length, 0.95, 0.12, 12.0)
    score += near((ankle[:, 2] - frame.floor) / unit, 0.1, 0.1, 5.0)
    score += at_least((knee[:, 2] - ankle[:, 2]) / np.maximum(lower, 1e-9), 0.93, 0.15, 4.0)
    score += near(hip[:, 0] / unit, 0.13, 0.07, 4.0)
    score += near(length, 0.45, 0.15, 3.0)
    for column, part in enumerate(LEG[:3]):
        score += part_scores(frame, part)[chains.bones[:, column]]
    score += np.where(chains.attached >= 0, 0.0, -2.0)
    return np.where(chains.bones[:, 2] >= 0, score, -np.inf)


def _arm_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) how well chains fit an arm by the places and names of their bones."""
    shoulder, elbow = (frame.place[chains.bones[:, part]] for part in range(2))
    has_hand = chains.bones[:, 2] >= 0
    tips = frame.ends[chains.bones[:, 1]]
    guess = np.where(np.isfinite(tips), tips, 2.0 * elbow - shoulder)
    wrist = np.where(has_hand[:, None], frame.place[chains.bones[:, 2]], guess)
    upper, lower = _length(elbow - shoulder), _length(wrist - elbow)
    length = np.maximum(upper + lower, 1e-9)
    score = near(upper / length, 0.52, 0.06)
    score += at_least(_length(wrist - shoulder) / length, 0.85, 0.15)
    score += at_most((wrist[:, 2] - shoulder[:, 2]) / length, 0.2, 0.3)
    score += near(shoulder[:, 0] / length, 0.33, 0.13, 4.0)
    score += near(length, 0.3, 0.12, 3.0)
    for column, part in enumerate(ARM[1:3]):
        score += part_scores(frame, part)[chains.bones[:, column]]
    score += np.where(has_hand, part_scores(frame, ARM[3])[chains.bones[:, 2]], NO_END)
    return score + np.where(chains.attached >= 0, 0.0, -2.0)


def _foot_scores(frame: Frame, chains: Chains, unit: Array) -> Array:
    """(C,) whether what hangs on each ankle lies ahead of it, as a foot does, and not far below."""
    found = np.zeros(len(chains))
    for row, end in enumerate(chains.bones[:, 2]):
        points = frame.branch[int(end)] - frame.place[int(end)]
        ahead = np.max(np.abs(points[:, 1])) / unit[row]
        below = -np.min(points[:, 2]) / unit[row]
        bare = len(points) < 2
        found[row] = -1.0 if bare else float(near(ahead, 0.25, 0.13, 2.0) + at_most(below, 0.2, 0.08, 5.0))
    return found


def _hand_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) whether fingers fan out where each hand begins."""
    bones = frame.bones
    leaves = [sum(not bones.children[each] for each in below) for below in bones.subtree]
    found = np.zeros(len(chains))
    for row, (_, middle, end) in enumerate(chains.bones):
        if end < 0:
            continue
        both = int(end), int(frame.symmetry.partner[end])
        reach = min(float(np.max(_length(frame.branch[each] - frame.place[each]))) for each in both)
        if reach > 0.0:  # one hand may hold something
            found[row] += float(near(reach / _reach(frame, chains.bones[row]), 0.33, 0.2, 4.0))
        found[row] += 2.0 if leaves[end] >= 3 else (0.3 if leaves[end] == 2 else 0.0)
        above = int(bones.parent[end])
        own = len(bones.subtree[end])
        rivals = [
            each
            for each in bones.children[above]
            if each != end and len(bones.subtree[each]) >= own and not bones.readings[each].mechanism
        ]
        found[row] -= 1.5 * min(len(rivals), 2)
        inner = [each for each in bones.subtree[middle] if each not in bones.subtree[end]]
        found[row] -= 0.8 * min(sum(len(bones.children[each]) >= 3 for each in inner if each != above), 2)
    return found


def _line_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) how little the bones that are left out bend the limb; the first of several of a part plays it."""
    parent, place = frame.bones.parent, frame.place
    parts = [reading.clear_part for reading in frame.bones.readings]
    found = np.zeros(len(chains))
    for row, (upper, middle, end) in enumerate(chains.bones):
        for top, low in ((upper, middle), (middle, end)):
            between = int(parent[low]) if low >= 0 else int(top)
            line = place[low] - place[top] if low >= 0 else np.zeros(3)
            reach = float(line @ line)
            while between not in (int(top), -1):
                off = place[between] - place[top]
                if reach > 0.0:
                    off = off - line * float(np.clip(off @ line / reach, 0.0, 1.0))
                found[row] -= 2.0 if parts[low] and parts[between] == parts[low] else 0.0
                found[row] -= 0.3 + min(20.0 * float(np.linalg.norm(off)) / np.sqrt(reach + 1e-9), 3.0)
                between = int(parent[between])
        above = int(parent[upper])
        if above >= 0 and frame.one_side[above]:
            found[row] -= 2.0 if parts[upper] and parts[above] == parts[upper] else 0.0
    return found


def _strand_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) strands of hair, skirts and capes have others beside them that are made alike; limbs have none."""
    bones, partner = frame.bones, frame.symmetry.partner
    found = np.zeros(len(chains))
    for row, upper in enumerate(chains.bones[:, 0]):
        top = int(upper)
        while bones.parent[top] >= 0 and frame.one_side[bones.parent[top]]:
            top = int(bones.parent[top])
        above = int(bones.parent[top])
        beside = bones.children[above] if above >= 0 else bones.roots
        alike = [
            bone
            for bone in beside
            if bone not in (top, partner[top])
            and len(bones.subtree[bone]) == len(bones.subtree[top]) > 1
            and 0.8 < _extent(frame, bone) / _extent(frame, top) < 1.25
        ]
        found[row] = -1.2 * min(len(alike), 2)
    return found


def _extent(frame: Frame, bone: int) -> float:
    return max(float(_length(frame.branch[bone] - frame.place[bone]).max()), 1e-9)


def _below_hip_scores(frame: Frame, chains: Chains) -> Array:
    """(C,) a leg begins with the first bone that lies on its side, not farther down."""
    found = np.zeros(len(chains))
    for row, upper in enumerate(chains.bones[:, 0]):
        above = int(frame.bones.parent[upper])
        if above >= 0 and frame.one_side[above]:
            aside = frame.place[above, 0] > 0.6 * frame.place[upper, 0]
            lower = frame.place[above, 2] > frame.place[upper, 2]
            found[row] = -2.0 if aside and lower else 0.0
    return found


def _with_toes(frame: Frame, legs: Limbs) -> Limbs:
    names = part_scores(frame, "toe")
    found, score = [], legs.score.copy()
    for row, bones in enumerate(legs.chains.bones):
        part, gain = _toe(frame, int(bones[2]), foot_unit(_reach(frame, bones)), names)
        found.append(part)
        score[row] += gain
    return Limbs(legs.chains, score, tuple(found))


def _toe(frame: Frame, foot: int, unit: float, names: Array) -> tuple[OptionalPart, float]:
    """The bone that bends below a foot, and its score; of several toes the one nearest to the middle."""
    ankle = frame.place[foot]
    points = frame.branch[foot] - ankle
    ahead = np.sign(points[int(np.argmax(np.abs(points[:, 1]))), 1]) or 1.0
    options = {}
    for bone in frame.bones.subtree[foot][1:]:
        x, y, z = (frame.place[bone] - ankle) / unit
        depth = len([each for each in frame.bones.ancestors(bone) if each in frame.bones.subtree[foot]])
        score = float(near(ahead * y, 0.2, 0.12, 6.0) + near(z, -0.09, 0.1, 3.0)) + names[bone]
        options[bone] = score - 0.7 * (depth - 1) - abs(x) - 2.0 * frame.place[bone, 0] / unit
    return _optional(options, NO_TOE)


def _with_shoulders(frame: Frame, arms: Limbs) -> Limbs:
    names = part_scores(frame, "shoulder")
    found, score = [], arms.score.copy()
    for row, bones in enumerate(arms.chains.bones):
        part, gain = _shoulder(frame, int(bones[0]), _reach(frame, bones), names)
        found.append(part)
        score[row] += gain
    return Limbs(arms.chains, score, tuple(found))


def _shoulder(frame: Frame, upper_arm: int, length: float, names: Array) -> tuple[OptionalPart, float]:
    """The collar bone above an upper arm, and its score."""
    above = [bone for bone in frame.bones.ancestors(upper_arm) if frame.one_side[bone]]
    options = {}
    for rank, bone in enumerate(reversed(above)):
        away = frame.place[upper_arm] - frame.place[bone]
        reach = float(_length(away))
        score = float(near(reach / length, 0.3, 0.15, 5.0)) - 0.3 * rank
        score += float(at_least(away[0] / max(reach, 1e-9), 0.5, 0.3, 4.0))
        score += float(near(frame.place[bone, 0] / length, 0.06, 0.1, 3.0)) + names[bone]
        options[bone] = score
    return _optional(options, NO_SHOULDER)


def _optional(options: dict[int, float], none: float) -> tuple[OptionalPart, float]:
    """The best of some bones or none of them, with its probability, and its score."""
    scores = {-1: none, **options} if options else {-1: 0.0}
    best, *others = sorted(scores, key=lambda bone: -scores[bone])
    weights = {bone: np.exp((score - scores[best]) / TEMPERATURE) for bone, score in scores.items()}
    share = float(1.0 / sum(weights.values()))
    return OptionalPart(best, share, others[0] if others else -1), min(scores[best], 3.0)


def foot_unit(leg: float) -> float:
    """Length [sizes] that measures of a foot are relative to: short legs may have usual feet."""
    return max(leg, SHORT_LEG)


def _reach(frame: Frame, bones: IndexArray) -> float:
    """Length of a chain [sizes]."""
    places = frame.place[[bone for bone in bones if bone >= 0]]
    whole = 1.0 if len(places) == len(bones) else 2.0
    return max(whole * float(_length(np.diff(places, axis=0)).sum()), 1e-9)


def _best(score: Array, count: int) -> IndexArray:
    return np.argsort(-score, kind="stable")[:count]


def _length(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
