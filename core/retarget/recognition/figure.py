"""Legs, arms and trunk put together: the likeliest figure, and how sure each part of it is."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, IndexArray
from ..roles import ARM, LEG
from .chains import Chains, find_chains
from .frame import Frame
from .likelihood import at_least, near
from .limbs import TEMPERATURE, Limbs, find_arms, find_legs, part_scores, quick_fit
from .trunk import Girdles, Trunk, find_trunk, fork_of

CLOSE = 12.0
"""Frames whose limbs fit worse than the best frame's by more than this are passed over."""
BEST_PAIRS = 12
"""Pairs of leg and arm for which a trunk is sought."""


@dataclass(frozen=True)
class Choice:
    """A bone for a part, and the next best."""

    bone: int
    """-1 where the figure lacks it."""
    probability: float
    rival: int = -1
    """The next likely bone; -1 for none."""


@dataclass(frozen=True, eq=False)
class Figure:
    """A frame's likeliest figure: bones of one side and of the middle."""

    frame: Frame
    limbs: Mapping[str, Choice]
    """By part of `roles.ARM` and `LEG`."""
    trunk: Trunk
    girdles: Girdles
    score: float
    uprightness: float
    """Cosine between the trunk and up."""
    names_score: float
    """What the names add to the score."""

    def bone(self, part: str) -> int:
        """The bone of a part of the limbs; -1 where the figure lacks it."""
        return self.limbs[part].bone


def find_figures(tried: list[Frame]) -> list[Figure]:
    """The likeliest figures of frames of the same bones, the best first.

    Frames in which no leg and no arm fits nearly as well as in the best are passed over.
    """
    chains = find_chains(tried[0]) if tried else None
    if chains is None or not len(chains):
        return []
    fits = [quick_fit(frame, chains) for frame in tried]
    close = [frame for frame, fit in zip(tried, fits, strict=True) if fit > max(fits) - CLOSE]
    figures = [figure for frame in close if (figure := find_figure(frame, chains)) is not None]
    return sorted(figures, key=lambda figure: -figure.score)


def find_figure(frame: Frame, chains: Chains) -> Figure | None:
    """The likeliest figure; None where there are no two pairs of limbs on one trunk."""
    legs, arms = find_legs(frame, chains), find_arms(frame, chains)
    if not len(legs.chains) or not len(arms.chains):
        return None
    pairs = _pair_scores(frame, legs, arms)
    order = np.argsort(-pairs, axis=None, kind="stable")[:BEST_PAIRS]
    trunks: dict[tuple[int, int, int, int], Trunk | None] = {}
    best: tuple[float, int, int, Trunk, Girdles] | None = None
    total = np.full(pairs.shape, -np.inf)
    for flat in order:
        leg, arm = divmod(int(flat), pairs.shape[1])
        if not np.isfinite(pairs[leg, arm]):
            break
        girdles = _girdles(frame, legs, arms, leg, arm)
        key = (
            girdles.legs_on,
            girdles.arms_on,
            int(legs.chains.bones[leg, 0]),
            int(arms.chains.bones[arm, 0]),
        )
        if key not in trunks:
            trunks[key] = find_trunk(frame, girdles)
        trunk = trunks[key]
        if trunk is None:
            continue
        total[leg, arm] = pairs[leg, arm] + trunk.score
        if best is None or total[leg, arm] > best[0]:
            best = (float(total[leg, arm]), leg, arm, trunk, girdles)
    if best is None:
        return None
    score, leg, arm, trunk, girdles = best
    rough = np.where(np.isfinite(total), total, pairs + trunk.score - 2.0)
    limbs = _choices(legs, arms, leg, arm, rough)
    up = girdles.shoulder - girdles.hip
    uprightness = float(up[2] / max(np.linalg.norm(up[1:]), 1e-9))
    return Figure(frame, limbs, trunk, girdles, score, uprightness, _names_score(frame, limbs, trunk))


def _names_score(frame: Frame, limbs: Mapping[str, Choice], trunk: Trunk) -> float:
    """What the names of chosen bones say of their parts."""
    there = {part: choice.bone for part, choice in limbs.items() if choice.bone >= 0}
    total = sum(float(part_scores(frame, part)[bone]) for part, bone in there.items())
    parts = (("hips", (trunk.hips,)), ("spine", trunk.spine), ("neck", trunk.neck))
    heads = () if trunk.head is None else (trunk.head,)
    for part, bones in (*parts, ("head", heads)):
        total += sum(float(part_scores(frame, part)[bone]) for bone in bones)
    return total


def _pair_scores(frame: Frame, legs: Limbs, arms: Limbs) -> Array:
    """(legs, arms) log-likelihood of each leg with each arm; -inf where they share a bone or a trunk."""
    hip, foot = (frame.place[legs.chains.bones[:, part]] for part in (0, 2))
    shoulder, elbow = (frame.place[arms.chains.bones[:, part]] for part in (0, 1))
    up = shoulder[None] - hip[:, None]
    reach = np.maximum(np.linalg.norm(up[..., 1:], axis=-1), 1e-9)
    leg = np.maximum(np.linalg.norm(hip - foot, axis=-1), 1e-9)
    arm = 2.0 * np.maximum(np.linalg.norm(elbow - shoulder, axis=-1), 1e-9)
    score = legs.score[:, None] + arms.score[None]
    score += at_least(up[..., 2] / reach, 0.95, 0.15, 12.0)
    score += near(np.log(reach / leg[:, None]), np.log(0.6), 0.35, 6.0)
    score += near(np.log(arm[None] / leg[:, None]), np.log(0.65), 0.35, 6.0)
    score += near(np.log((shoulder[None, :, 0] + 1e-3) / (hip[:, None, 0] + 1e-3)), np.log(1.9), 0.45, 5.0)
    score += near(up[..., 1] / reach, 0.0, 0.12, 3.0)
    for row, column in np.ndindex(*score.shape):
        if not _compatible(frame, legs, arms, row, column):
            score[row, column] = -np.inf
    return np.asarray(score)


def _compatible(frame: Frame, legs: Limbs, arms: Limbs, leg: int, arm: int) -> bool:
    """Whether neither limb is part of the other, and both hang on one trunk."""
    first, second = (int(limbs.chains.bones[row, 0]) for limbs, row in ((legs, leg), (arms, arm)))
    below = frame.bones.subtree
    if second in below[first] or first in below[second]:
        return False
    both = int(legs.chains.attached[leg]), int(arms.chains.attached[arm])
    return fork_of(frame, *both) >= 0


def _girdles(frame: Frame, legs: Limbs, arms: Limbs, leg: int, arm: int) -> Girdles:
    legs_on, arms_on = int(legs.chains.attached[leg]), int(arms.chains.attached[arm])
    hip = frame.place[legs.chains.bones[leg, 0]] * [0.0, 1.0, 1.0]
    shoulder = frame.place[arms.chains.bones[arm, 0]] * [0.0, 1.0, 1.0]
    return Girdles(hip, shoulder, legs_on, arms_on, fork_of(frame, legs_on, arms_on))


def _choices(legs: Limbs, arms: Limbs, leg: int, arm: int, total: Array) -> dict[str, Choice]:
    """The bone of each part of the limbs, its probability over all pairs, and the next likely bone."""
    finite = np.isfinite(total)
    weight = np.where(finite, np.exp((np.where(finite, total, 0.0) - total[leg, arm]) / TEMPERATURE), 0.0)
    of_leg, of_arm = weight.sum(axis=1), weight.sum(axis=0)
    found = {}
    columns: list[tuple[str, IndexArray, Array, int]]
    columns = [(part, legs.chains.bones[:, row], of_leg, leg) for row, part in enumerate(LEG[:3])]
    columns += [(part, arms.chains.bones[:, row], of_arm, arm) for row, part in enumerate(ARM[1:])]
    for part, limbs, weights, chosen in ((LEG[3], legs, of_leg, leg), (ARM[0], arms, of_arm, arm)):
        columns.append((part, np.array([option.bone for option in limbs.optional]), weights, chosen))
    for part, bones, weights, chosen in columns:
        bone = int(bones[chosen])
        shares = {int(each): float(weights[bones == each].sum()) for each in set(bones.tolist())}
        share = shares[bone] / max(sum(shares.values()), 1e-12)
        rivals = sorted((each for each in shares if each != bone), key=lambda each: -shares[each])
        found[part] = Choice(bone, share, rivals[0] if rivals else -1)
    for part, option in ((LEG[3], legs.optional[leg]), (ARM[0], arms.optional[arm])):
        choice = found[part]
        rival = option.rival if option.probability < choice.probability else choice.rival
        found[part] = Choice(option.bone, choice.probability * option.probability, rival)
    return found
