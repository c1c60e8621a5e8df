"""What can be checked of poses that nobody posed, and how probable it makes them.

Each check holds two sources against each other that do not know of each other: a network's guess in space
against the performer's height, the feet against the floor. That keypoints lie on the poses made from them is
none: wrong ones do as well.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..body.human import HUMAN, LIMB_SEGMENTS
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..estimate.performer_placement import feet_over_floor_m
from ..estimate.sigma import GROUND_STD_M
from ..files.fields import listed
from ..take.presence import named_limbs
from .clip_input import PosingInput
from .found_poses import PROBABILITY_BOUNDS, MatchedFrame

GUESSED_SIZE, GUESSED_SIZE_STD = 0.89, 0.07
"""Length of limbs by a network's guess over that between the joints' centers, and the deviation of its
logarithm: a network draws everybody at about one size, so heights that are unusual are doubted."""
WRONG_SHARE = 0.1  # of all takes whose height, camera or floor are wrong: a round guess
USABLE = 0.5  # least confidence
AGREES = 0.8  # least probability of what a check finds
SEEN_SHARE = 0.9  # of the frames; where somebody is seen in less, that is said


def agreement(
    posing: PosingInput, postures: Posture, frames: Sequence[MatchedFrame], floor_m: float | None
) -> tuple[float, str]:
    """Probability that a found motion is usable, and a sentence with what speaks for or against it.

    Usable is a mean error of less than 10 cm, the hips aligned, and of half a meter in place. `frames` are
    those proposed for keyframes; `floor_m` is None where the floor is wherever the feet are.
    """
    chosen = [frame.candidates[0].confidence for frame in frames]
    probability = float(np.mean(chosen)) if chosen else 0.0
    agree: list[str] = []
    against: list[str] = []
    points = posing.body.points(posing.body.pose(postures[posing.sampled]))
    size = None if posing.unseen else _relative_size(posing, points)  # it has learned whole bodies
    if size is not None:
        own = _right(float(np.log(size)), GUESSED_SIZE_STD, 0.7)  # in a range of wrong heights
        probability *= own
        what = f"by the detector's guess in space the performer is {abs(size - 1.0):.0%} "
        fault = what + ("taller" if size > 1.0 else "shorter") + " than stated"
        (agree if own >= AGREES else against).append("the detector's sizes" if own >= AGREES else fault)
    if floor_m is not None and any(posing.feet_seen):
        off_m = feet_over_floor_m(posing.body, points, floor_m)
        own = _right(off_m, GROUND_STD_M, 1.0)  # anywhere in it where camera, height or floor are wrong [m]
        probability *= own
        fault = f"the feet are {abs(off_m) * 100.0:.0f} cm {'above' if off_m > 0.0 else 'below'} the floor"
        (agree if own >= AGREES else against).append("the floor" if own >= AGREES else fault)
    probability *= posing.share
    if posing.share < SEEN_SHARE:
        against.append(f"nobody is seen in {1.0 - posing.share:.0%} of the frames")
    if posing.unseen:
        probability *= 0.5 ** len(posing.unseen)  # that a limb which is never seen is about right
        against.append(f"{named_limbs(posing.unseen)} never seen")
    if not against and probability < USABLE:
        against.append("other postures look alike")
    probability = float(np.clip(probability, *PROBABILITY_BOUNDS))
    verdict = "usable" if probability >= USABLE else "doubtful"
    # "The detector's sizes agree", but "the floor agrees".
    verb = "agrees" if agree == ["the floor"] else "agree"
    reasons = listed(against, 4) if against else f"{' and '.join(agree)} {verb}" if agree else ""
    return probability, f"the found poses are {verdict}, {probability:.0%} sure" + (
        f": {reasons}" if reasons else ""
    )


def _relative_size(posing: PosingInput, points: Array) -> float | None:
    """How tall the performer is by the network's guess, over points (T, P, 3); None without one."""
    keypoints = posing.evidence.keypoints
    # Of points beyond the picture's edge a network guesses even the place.
    hints = np.where(keypoints.seen[..., None], keypoints.hint_m, np.nan)[posing.sampled]
    names = keypoints.names
    ratios = []
    for pair in [(f"{root}.{side}", f"{end}.{side}") for side in SIDES for _, root, end in LIMB_SEGMENTS]:
        if set(pair) <= set(names):
            root, end = (hints[:, names.index(name)] for name in pair)
            known = np.isfinite(end - root).all(axis=-1)
            if known.any():
                own = np.subtract(*(points[0, HUMAN.point_names.index(name)] for name in pair))
                length = np.median(np.linalg.norm((end - root)[known], axis=-1))
                ratios.append(float(length / np.linalg.norm(own)))
    return float(np.median(ratios)) / GUESSED_SIZE if ratios else None


def _right(off: float, std: float, spread: float) -> float:
    """Probability that a deviation is one of what is right: normal, else anywhere within a range."""
    right = (1.0 - WRONG_SHARE) * np.exp(-0.5 * (off / std) ** 2) / (std * np.sqrt(2.0 * np.pi))
    return float(right / (right + WRONG_SHARE / spread))
