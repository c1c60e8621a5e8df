"""What a reference motion tells of a take: whether it is of this performance, how far it errs, keyframes.

A network's error is a bias that wanders: it lasts for some tenths of a second, is larger along the line of
sight, and a posed keyframe tells it nearby.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ndtr, stdtr

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN
from ..body.posture import Posture
from ..body.posture_fit import fit_posture
from ..detect.keypoints import Keypoints
from ..detect.performer import principal_keypoints
from ..errors import pluralize
from ..numerics.robust import DEGREES
from ..numerics.vectors import gaussian, usual_step
from ..prior.keyframes import Keyframe, Matched
from ..prior.texts import REFERENCE
from ..take.presence import SeenTake
from ..take.reference import ReferenceMotion
from ..take.take import Take
from ..terms.reference import ExpectedPoints
from .reference_alignment import AlignedReference, about_hips, align, of_performer
from .reference_placement import SeenPoints, place

USUAL_STD_M = {
    "hip": 0.015,
    "shoulder": 0.025,
    "head": 0.03,
    "elbow": 0.035,
    "knee": 0.035,
    "ankle": 0.045,
    "wrist": 0.05,
}
"""Usual error of a network's point about the hips, along each axis across the line of sight [m]."""
STD_M = np.array([USUAL_STD_M[name.partition(".")[0]] for name in HUMAN.point_names])
LIMBS = np.array([name.startswith(("elbow", "wrist", "knee", "ankle")) for name in HUMAN.point_names])


ALONG = 2.2  # usual error along the line of sight, in those across it
HINT_STD_M = 0.1  # of a point that the keypoints' own network guesses, along it
SURE_M = 0.1  # mean error of a point up to which it is no worse than poses that are found in libraries
FACTORS = 0.7, 3.0  # least and largest factor on the usual error
KEYFRAME_WIDTH = 4.0  # error of its keyframes, in a usual difference between performers
LEAST_GAIN = 0.29  # right motions cost .1 to .3 of what they cost at other times, others more than .7
OTHER_TIMES = 21
STRETCH_S = 0.5  # in which errors are alike
MIRRORED_BY_CHANCE = 0.05  # probability, by Student's t, up to which a motion is said to have near for far


@dataclass(frozen=True, eq=False)
class ReferenceEvidence:
    """What a believed reference motion tells of F frames."""

    expected: ExpectedPoints
    keyframes: tuple[Keyframe, ...]  # found in it, away from posed ones
    left_out: BoolArray  # (F,) where it is of something else
    error_m: float  # usual error of a point
    gain: float  # 1 less its cost relative to that of the same motion at other times
    name: str  # for sentences
    notes: tuple[str, ...]  # sentences for people

    @property
    def confidence(self) -> float:
        """Probability that its postures are right to 10 cm."""
        return _confidence(self.error_m)

    @property
    def is_sure(self) -> bool:
        """Whether its postures are worth more than such as are found in libraries."""
        return self.error_m <= SURE_M and not self.left_out.any()


@dataclass(frozen=True, eq=False)
class NoReference:
    """A reference motion that is set aside, and why."""

    notes: tuple[str, ...]


def reference_evidence(seen_take: SeenTake) -> ReferenceEvidence | NoReference:
    """What a take's reference motion tells; its posed keyframes correct it."""
    take, tracks, keypoints = seen_take.take, seen_take.reading.tracks, seen_take.keypoints
    assert take.reference is not None
    name = take.reference.name
    posed = tuple(key for key in take.keyframes if key.matched is None)
    if _is_own_guess(take.reference, keypoints):
        own = (
            f"{name}: is set aside, since it is the guess in space that came with the keypoints, whose "
            "errors it shares"
        )
        return NoReference((own,))
    seen = SeenPoints.of(take.camera, keypoints, tracks, take.marker_segments)
    aligned = align(take.reference, take.body, seen, tracks.time_s, take.fps)
    cost, usual = own_and_usual_cost(aligned, seen)
    gain = 1.0 - cost / usual
    if gain < LEAST_GAIN:
        other = (
            f"{name}: is set aside, since it fits the footage hardly better than the same motion at "
            f"other times ({gain:.2f}); it must be of this clip"
        )
        return NoReference((other,))
    off_m, mirrored = _off_hints_m(take, keypoints, aligned, seen, tracks.time_s)
    if mirrored:
        turned = (
            f"{name}: is set aside, since it has near for far: its mirror image is nearer in depth to "
            "what the keypoints' network guesses"
        )
        return NoReference((turned,))
    left_out = _left_out(aligned, usual, tracks.time_s)
    # 0.09: of the local quadratic that takes its jitter away
    points = smoothed(aligned.points, tracks.time_s, 0.09)
    points[left_out] = np.nan
    factor = error_factor(aligned, seen, tracks.time_s)
    along = max(
        float(np.sqrt(np.mean(factor**2))),
        float(np.sqrt(max(off_m**2 - HINT_STD_M**2, 0.0)) / (ALONG * np.sqrt(np.mean(STD_M**2)))),
    )
    along = min(along, FACTORS[1])
    hips = aligned.hips
    if posed:
        index = np.array([key.index for key in posed])
        true = take.body.points(take.body.pose(Posture.stack([key.posture for key in posed])))
        offset = about_hips(true) - points[index]
        known = np.isfinite(offset).all(axis=(1, 2))
        if known.any():
            index, offset, middle = index[known], offset[known], (true - about_hips(true))[known, 0]
            off = (_whitening(take, hips, factor, along)[index] @ offset[..., None])[..., 0]
            squared = np.mean(off**2, axis=(1, 2))
            # 3.0: posed keyframes that what is seen weighs as much as
            scale = float(np.sqrt((3.0 + squared.sum()) / (3.0 + len(squared))))
            factor, along = np.clip(scale * factor, *FACTORS), float(np.clip(scale * along, *FACTORS))
            share = _bias(tracks.time_s[index], tracks.time_s)
            points = points + np.einsum("fk,kpi->fpi", share, offset)
            hips = hips + share @ (middle - hips[index])
    # 0.4 s: time in which its errors fade
    known_points = np.where(aligned.known[:, None, None], points, np.nan)
    expected = ExpectedPoints(known_points, _whitening(take, hips, factor, along), 0.4)
    error_m = float(STD_M.mean() * np.sqrt(2.0 * np.mean(factor**2) + (ALONG * along) ** 2))
    matched = Matched(REFERENCE, name, False, _confidence(error_m))
    found = _keyframes(take, points + hips[:, None], posed, tracks.time_s, matched)
    notes = [
        f"{name}: a motion from elsewhere is followed; its points are about "
        f"{100.0 * error_m:.0f} cm off by what is seen"
    ]
    for count, what in (
        (aligned.exchanged.sum(), "left and right are exchanged back"),
        (left_out.sum(), "is of something else and left out"),
    ):
        notes += [f"{name}: {what} in {pluralize(int(count), 'frame')}"] if count else []
    if aligned.lag:
        notes.append(
            f"{name}: is {pluralize(abs(aligned.lag), 'frame')} {'late' if aligned.lag > 0 else 'early'}, "
            "which is taken back"
        )
    return ReferenceEvidence(expected, found, left_out, error_m, gain, name, tuple(notes))


def with_reference(take: Take, reference: ReferenceEvidence) -> Take:
    """The take with the keyframes found in its reference motion; others found stay where it is silent.

    One that is not sure brings none beside others.
    """
    others = [key for key in take.keyframes if key.matched is None or not key.matched.is_referred]
    if not reference.is_sure and len(others) > 1 and any(key.matched is not None for key in others):
        return replace(take, keyframes=tuple(others))
    kept = [
        key
        for key in take.keyframes
        if key.matched is None or (not key.matched.is_referred and reference.left_out[key.index])
    ]
    return replace(take, keyframes=tuple(sorted((*kept, *reference.keyframes), key=lambda key: key.index)))


def _confidence(error_m: float) -> float:
    """Probability that a network's posture is right to 10 cm, given its usual error.

    Mean errors of single postures are spread by half an octave, about log-normally.
    """
    return float(np.clip(ndtr(np.log(0.1 / error_m) / 0.4), 0.02, 0.98))


def _is_own_guess(reference: ReferenceMotion, keypoints: Keypoints) -> bool:
    """Whether a reference motion is what the detector guessed with its keypoints: it errs as they do."""
    hint = principal_keypoints(keypoints).hint_m if keypoints.names else np.zeros((0, len(STD_M), 3))
    frames = min(len(hint), len(reference.points_m))
    one, other = about_hips(reference.points_m[:frames]), about_hips(hint[:frames])
    known = np.isfinite(one).all(axis=(1, 2)) & np.isfinite(other).all(axis=(1, 2))
    if known.sum() < 2:
        return False
    one, other = one[known].reshape(-1, 3), other[known].reshape(-1, 3)
    turn, _ = Rotation.align_vectors(other, one)
    one = turn.apply(one)
    size = float((one * other).sum() / max((one * one).sum(), 1e-9))
    # Within 2 cm in the median it is the detector's own guess in space.
    return bool(np.median(np.linalg.norm(size * one - other, axis=-1)) < 0.02)


def _left_out(aligned: AlignedReference, usual: float, time_s: Array) -> BoolArray:
    """(F,) where a motion fits no better than at other times."""
    known = np.isfinite(aligned.placed.cost)
    # 0.3: time over which frames are judged together
    width = 0.3 / usual_step(time_s)
    near = gaussian(np.where(known, aligned.placed.cost, 0.0), width) / np.maximum(
        gaussian(1.0 * known, width), 1e-9
    )
    return np.asarray(near > (1.0 - LEAST_GAIN) * usual)


def _whitening(take: Take, hips: Array, across: Array, along: float) -> Array:
    """(F, 13, 3, 3) inverse standard deviations by errors across (F,) and along the view in usual ones."""
    sight = take.camera.sight(hips, np.arange(len(hips)))
    away = sight[:, :, None] * sight[:, None, :]
    shape = (np.eye(3) - away) / across[:, None, None] + away / (ALONG * along)
    return np.asarray(shape[:, None] / STD_M[:, None, None])


def _keyframes(
    take: Take, points: Array, posed: tuple[Keyframe, ...], time_s: Array, matched: Matched
) -> tuple[Keyframe, ...]:
    """Keyframes at even times, where all points are known and no posed keyframe is near."""
    # 0.4: time between the keyframes found in it
    count = max(1, round((time_s[-1] - time_s[0]) / 0.4)) + 1
    frames = np.unique(np.linspace(0, len(points) - 1, count).round().astype(np.intp))
    near = np.array([key.index for key in posed], dtype=np.intp)
    apart = np.abs(time_s[frames][:, None] - time_s[near]).min(axis=1, initial=np.inf)
    # None is found within 0.3 s of a posed one.
    frames = frames[(apart > 0.3) & np.isfinite(points[frames]).all(axis=(1, 2))]
    if not len(frames):
        return ()
    posture = fit_posture(take.body, points[frames]).posture
    return tuple(Keyframe(int(frame), posture[row], matched=matched) for row, frame in enumerate(frames))


def _bias(at_s: Array, time_s: Array) -> Array:
    """(F, K) weights that tell a bias at other times by what it is at K.

    What is left is believed no more for it: with a smaller deviation beside keyframes posed by hand, slow
    motions came out worse than without it.
    """

    def covariance(one: Array, other: Array) -> Array:
        # 0.3: share of the bias that lasts all along the clip; 0.5 s: time in which the rest fades
        return np.asarray(0.3 + 0.7 * np.exp(-np.abs(one[:, None] - other) / 0.5))

    # 0.1: variance of a person's own error, relative to the bias's
    known = covariance(at_s, at_s) + 0.1 * np.eye(len(at_s))
    return np.asarray(np.linalg.solve(known, covariance(at_s, time_s)).T)


# --- Its worth


def own_and_usual_cost(aligned: AlignedReference, seen: SeenPoints) -> tuple[float, float]:
    """What the footage costs given the motion, and given it at other times, forward and backward."""
    inside = np.einsum("fji,fpj->fpi", seen.rotation, aligned.points)
    known = np.flatnonzero(np.isfinite(aligned.placed.cost))
    if len(known) < 2:
        return 1.0, 1.0
    # 400 frames are asked.
    known = known[np.unique(np.linspace(0, len(known) - 1, 400).round().astype(int))]
    some, part, count = inside[known], seen[known], len(known)
    others = []
    for number in range(OTHER_TIMES):
        order = np.arange(count)[:: 1 - 2 * (number % 2)]
        other = np.roll(order, round((number + 1) * count / (OTHER_TIMES + 1)))
        others.append(float(np.nanmean(place(some[other], part).cost)))
    return float(np.nanmean(place(some, part).cost)), max(float(np.median(others)), 1e-9)


def error_factor(aligned: AlignedReference, seen: SeenPoints, time_s: Array) -> Array:
    """(F,) the motion's error across the view in usual ones, by limbs' points in the picture."""
    squared = (aligned.placed.residual_m**2).sum(axis=-1)  # (F, A) of two axes
    limb = np.isfinite(squared).any(axis=0) & (seen.mean @ LIMBS > 0.99)
    share = squared[:, limb] / (seen.mean @ STD_M)[limb] ** 2
    known = np.isfinite(share).any(axis=1)
    if not known.any():
        return np.ones(len(squared))
    # The median of two axes' square is 2 log 2 variances.
    usual = np.zeros(len(share))
    usual[known] = np.nanmedian(share[known], axis=1) / (2.0 * np.log(2.0))
    # 0.4 s: its errors last so long
    width = 0.4 / usual_step(time_s)
    near = gaussian(usual, width) / np.maximum(gaussian(1.0 * known, width), 1e-9)
    return np.clip(np.sqrt(near), *FACTORS)


def _off_hints_m(
    take: Take, keypoints: Keypoints, aligned: AlignedReference, seen: SeenPoints, time_s: Array
) -> tuple[float, bool]:
    """How far it is from what the keypoints' own network guesses in depth [m], and whether it mirrors that.

    0 where nothing is guessed. Errors of both last, so that stretches of time count, not frames.
    """
    hint = principal_keypoints(keypoints).hint_m if keypoints.names else np.full(aligned.points.shape, np.nan)
    known = aligned.known & np.isfinite(hint).all(axis=(1, 2))
    if not known.any():
        return 0.0, False
    away = -np.einsum("fj,fpj->fp", seen.rotation[known, :, 2], aligned.points[known])
    guess = of_performer(take.body, about_hips(hint[known]))[..., 2]
    _, stretch = np.unique(time_s[known] // STRETCH_S, return_inverse=True)
    alike = np.bincount(stretch, (away * guess).sum(axis=1)) / np.bincount(stretch)
    doubt_m2 = np.std(alike, ddof=1) / np.sqrt(len(alike)) if len(alike) > 1 else np.inf
    mirrored = stdtr(len(alike) - 1, np.mean(alike) / max(doubt_m2, 1e-9)) < MIRRORED_BY_CHANCE
    return float(np.sqrt(np.mean((away - guess) ** 2))), bool(mirrored)


# --- Its jitter


def smoothed(points: Array, time_s: Array, width_s: float) -> Array:
    """Points (F, N, 3) by a local quadratic under a Gaussian of `width_s` (Savitzky & Golay; Cleveland 1979).

    Robust: points far from their own curve count for less. NaN only where hardly a frame near is known.
    """
    reach = max(1, round(3.0 * width_s / usual_step(time_s)))
    offsets = np.arange(-reach, reach + 1)
    known = np.isfinite(points).all(axis=-1)
    value = np.where(known[..., None], points, 0.0)
    trust: Array = known.astype(np.float64)
    result = points
    for _ in range(3):
        result = _quadratic(value, trust, time_s, offsets, width_s)
        off = np.where(known, np.linalg.norm(value - result, axis=-1), np.nan)
        usual = np.nanmedian(off, axis=0) if known.any() else np.ones(points.shape[1])
        trust = np.where(known, DEGREES / (DEGREES + np.nan_to_num(off / np.maximum(usual, 1e-4)) ** 2), 0.0)
    return result


def _quadratic(value: Array, trust: Array, time_s: Array, offsets: IndexArray, width_s: float) -> Array:
    frames = len(value)
    normal = np.zeros((*trust.shape, 3, 3))
    right = np.zeros((*trust.shape, 3, 3))
    enough = np.zeros(trust.shape)
    for offset in offsets:
        at = np.arange(max(0, -offset), min(frames, frames - offset))
        away = (time_s[at + offset] - time_s[at]) / width_s
        weight = np.exp(-0.5 * away**2)[:, None] * trust[at + offset]
        basis = np.stack([np.ones_like(away), away, away**2], axis=-1)
        normal[at] += weight[..., None, None] * (basis[:, :, None] * basis[:, None, :])[:, None]
        right[at] += weight[..., None, None] * basis[:, None, :, None] * value[at + offset][..., None, :]
        enough[at] += weight
    normal += 1e-6 * np.eye(3)
    result = np.linalg.solve(normal, right)[..., 0, :]
    return np.where((enough > 0.5)[..., None], result, np.nan)
