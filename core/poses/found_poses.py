"""Postures found in footage without posing, with the candidates of every proposed frame."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import expit, logit

from ..arrays import Array, IndexArray, SingleArray
from ..body.posture import Posture
from ..errors import MOST_NAMED, frames_in_words
from ..estimate.performer_placement import found_ankle_m, standing_ankle_m
from ..estimate.reference_evidence import ReferenceEvidence
from ..prior.keyframes import Keyframe, Matched, interpolate
from ..prior.texts import COMPOSED, REFERENCE
from ..take.take import Take
from .composed_states import FrameStates
from .part_features import HEADINGS, StanceFeatures

DISTINCT_M = 0.08  # postures whose points differ by less on average, the hips aligned, look the same
ABOUT_RIGHT_M = 0.10  # mean distance of the points, the hips aligned, within which a match is about right
PROBABILITY_BOUNDS = 0.02, 0.98  # probabilities are clipped to these before their odds are taken
CHOSEN, OTHER = (-0.1, 0.5, 1.0 / 3.0), (-2.0, 2.0 / 3.0, 1.0 / 3.0)
"""Logistic regressions, rounded, of being about right, of the chosen posture, which the whole clip led to,
and of the others, on 25 recordings with truth: of 237 chosen ones said to be up to 40, 60, 80 and 100 % sure,
39, 45, 68 and 90 % were; of 1185 others up to 20, 40, 60 and 80 %, 14, 27, 53 and 63 %."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """A posture that a frame may show, of a library or put together from parts."""

    posture: Posture  # of the take's body, in the world
    name: str
    """Name of the libraries' posture nearest to it, or to its trunk where it was put together; empty where
    no library was asked."""
    mirrored: bool  # whether it is nearest to the mirror image of that
    confidence: float  # probability that it is about right, 0 to 1


@dataclass(frozen=True, eq=False)
class MatchedFrame:
    """The candidates of one frame."""

    index: int  # Index in the clip
    candidates: tuple[Candidate, ...]  # the chosen one first, then the alternatives, the likelier first


def composed_candidates(
    stances: StanceFeatures,
    states: FrameStates,
    posterior: SingleArray,
    chosen: Posture,
    torso: int,
    explained: float,
) -> tuple[Candidate, ...]:
    """The chosen posture of a frame and distinct ones beside it, the likelier first.

    `posterior` (K,) are the states' probabilities given the whole clip; the `chosen` posture is that fitted
    to the footage, with the `torso` of the pool, and the share of the frame that it explains, 0 to 1.
    """
    likely = np.argsort(-posterior, kind="stable")[:60]
    some, pools = states.chosen(likely), stances.pools
    composed = stances.composed(some.stance, some.limbs, some.hips)
    everyone = Posture.concatenate([Posture.stack([chosen]), composed])
    shape = pools.body.points(pools.body.pose(everyone)) - everyone.translation[:, None]
    weight = np.concatenate([[0.0], posterior[likely] / max(float(posterior[likely].sum()), 1e-12)])
    kept = distinct_rows(shape, np.arange(len(shape)), DISTINCT_M, most=6)
    found = []
    for rank in map(int, kept):
        near = np.linalg.norm(shape - shape[rank], axis=-1).mean(axis=-1) < ABOUT_RIGHT_M
        own = torso if rank == 0 else int(some.stance[rank - 1]) // HEADINGS
        name, flipped = pools.names[pools.torsos.source[own]]
        shares = log_odds(float(weight[near].sum())), log_odds(explained)
        found.append(Candidate(everyone[rank], name, flipped, confidence(OTHER if rank else CHOSEN, *shares)))
    return by_confidence(found)


def by_confidence(found: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Candidates in the order of their confidence, but for the chosen one, which stays first."""
    return (*found[:1], *sorted(found[1:], key=lambda each: -each.confidence))


def log_odds(probability: float) -> float:
    """Logarithm of a probability's odds, within `PROBABILITY_BOUNDS`."""
    return float(logit(np.clip(probability, *PROBABILITY_BOUNDS)))


def confidence(coefficients: tuple[float, float, float], *tells: float) -> float:
    """Probability that a posture is about right, by a logistic regression: its constant comes first.

    What tells is the share of the probability that the posture and those near it have among all that are
    known, and how well it explains the frame: one that beats all others may still be wrong.
    """
    return float(expit(np.dot(coefficients, (1.0, *tells))))


def distinct_rows(points: Array, order: IndexArray, apart_m: float, most: int) -> IndexArray:
    """At most `most` rows, the first in `order`, of postures (S, P, 3) that are `apart_m` apart."""
    kept: list[int] = []
    for row in map(int, order):
        if not kept or np.linalg.norm(points[kept] - points[row], axis=-1).mean(axis=-1).min() > apart_m:
            kept.append(row)
        if len(kept) == most:
            break
    return np.array(kept, dtype=np.intp)


# --- The poses of a clip


NEAR_FRAMES = 2  # found keyframes keep farther than this from posed ones


@dataclass(frozen=True, eq=False)
class FoundPoses:
    """The most probable postures of a clip that nobody posed."""

    frames: tuple[MatchedFrame, ...]  # in order, those proposed for keyframes
    postures: Posture  # (F,) the posture in every frame of the clip
    fit: float  # probability that the motion is usable, 0 to 1, see `agreement`
    floor_m: float  # height of the floor that the performer stands on [m]
    reason: str  # sentence for people: whether it is usable, and what speaks for or against it
    contradictions: Mapping[int, tuple[str, ...]] = field(default_factory=dict)
    """Names of the markers and keypoints that no plausible posture explains, by index of a proposed frame."""
    library: str = COMPOSED  # identifier of the library that all was composed of, where only one was asked
    between: tuple[int, int] | None = None  # first and last frame that were looked at; None for all

    def keyframe(self, frame: MatchedFrame, index: int | None = None) -> Keyframe:
        """The found keyframe with a frame's chosen candidate, or at another index with the posture there."""
        chosen = frame.candidates[0]
        at = frame.index if index is None else index
        posture = chosen.posture if at == frame.index else self.postures[at]
        match = Matched(COMPOSED, chosen.name, chosen.mirrored, chosen.confidence)
        return Keyframe(at, posture, matched=match)

    def lowered(self, by_m: float) -> "FoundPoses":
        """The same in a world that is so much lower."""

        def lower(frame: MatchedFrame) -> MatchedFrame:
            candidates = (replace(each, posture=each.posture.lowered(by_m)) for each in frame.candidates)
            return replace(frame, candidates=tuple(candidates))

        frames, postures = tuple(map(lower, self.frames)), self.postures.lowered(by_m)
        return replace(self, frames=frames, postures=postures, floor_m=self.floor_m - by_m)

    def sought(self, index: int) -> bool:
        """Whether a frame was looked at."""
        return self.between is None or self.between[0] <= index <= self.between[1]


def with_found(take: Take, found: FoundPoses) -> Take:
    """The take with the found keyframes; posed ones stay, and found ones make room for them.

    Beside a posed keyframe a found one tells how the performer differs from the postures it was made of
    (`found_doubt`). Keyframes that were found earlier go, except where none was sought now.
    """
    posed = [key.index for key in take.keyframes if key.matched is None]
    kept = {key.index: key for key in take.keyframes if key.matched is None or not found.sought(key.index)}
    keyframes: dict[int, Keyframe] = {}
    for frame in found.frames:
        # The frame itself or, near a posed keyframe, the nearest one that is far enough.
        reach = sorted(range(-NEAR_FRAMES - 1, NEAR_FRAMES + 2), key=abs)
        inside = [frame.index + step for step in reach if 0 <= frame.index + step < found.postures.batch[0]]
        free = [at for at in inside if all(abs(at - other) > NEAR_FRAMES for other in posed)]
        if free and free[0] not in keyframes:
            keyframes[free[0]] = found.keyframe(frame, free[0])
    return replace(take, keyframes=tuple(each for _, each in sorted((keyframes | kept).items())))


def referred_poses(take: Take, reference: ReferenceEvidence) -> FoundPoses:
    """The poses that a take has from its reference motion, among its keyframes already."""
    count = len(reference.expected.points)
    postures = interpolate(take.keyframes, count)
    frames = tuple(
        MatchedFrame(key.index, (Candidate(key.posture, "", False, reference.confidence),))
        for key in reference.keyframes
    )
    every = np.arange(count)
    lower = found_ankle_m(take.body, postures, every, count)
    floor_m = float(np.min(lower)) - standing_ankle_m(take.body)
    reason = (
        f"the found poses are those of {reference.name}, which fits the footage {reference.gain:.0%} better "
        "than chance"
    )
    return FoundPoses(frames, postures, reference.gain, floor_m, reason, library=REFERENCE)


# --- Notes on evidence that no plausible posture explains, one sentence each


def contradiction_notes(take: Take, found: FoundPoses) -> tuple[str, ...]:
    """Notes on markers and keypoints that contradict, those of the most frames first."""
    frames: dict[str, list[int]] = {}
    for index, names in sorted(found.contradictions.items()):
        for name in names:
            frames.setdefault(name, []).append(index + take.frame_start)
    markers = {marker.name for marker in take.markers}
    notes = []
    for name in sorted(frames, key=lambda name: (-len(frames[name]), name))[:MOST_NAMED]:
        kind = "marker" if name in markers else "keypoint"
        notes.append(f"{frames_in_words(frames[name], MOST_NAMED)}: no plausible pose explains {kind} {name}")
    return tuple(notes)
