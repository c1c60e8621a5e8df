"""Calibration of hints of depth on posed keyframes: what a link's depth is expected to be by its guess.

By Bayesian linear regression, link by link, with links on both sides of the body alike. A guess that tells
nothing gets a gain near zero, or an error so large that it does not matter.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IndexArray
from ..body.kinematics import Body, Pose
from ..camera.camera import Camera
from ..detect.keypoints import mirrored_point
from ..terms.depths import DepthLinks
from ..terms.keypoints import LEAST_CONFIDENCE, PIXEL_STD, USUAL_PLACES, KeypointModel, ObservedKeypoints
from .keyframe_rows import EvidenceRows

HINT_ERROR = 0.2  # error of a guess over the link's length: the sine of some twelve degrees
LARGEST_ERROR = 4.0  # a larger error, in standard deviations, counts as one this large


@dataclass(frozen=True, eq=False)
class DepthEvidence:
    """What the L links' guesses are worth."""

    links: DepthLinks
    gain: Array  # (L,) expected depth by a guess: gain times guess plus offset
    offset_m: Array  # (L,)
    std_m: Array  # (L,) error of what is expected [m]
    memory_s: float = 0.25  # time in which an error fades to a third [s]

    @classmethod
    def usual(cls, links: DepthLinks, model: KeypointModel) -> "DepthEvidence":
        """Guesses taken as they are, before any keyframe is posed."""
        length = links.lengths_m(model)
        return cls(links, np.ones_like(length), np.zeros_like(length), HINT_ERROR * length)

    def unposed(self) -> "DepthEvidence":
        """The same where no keyframe is posed, which would take away what is wrong alike in all frames."""
        # Networks have points 6 to 18 cm too near or far, of which three in ten of a link's length is 10 cm.
        return replace(self, std_m=1.5 * self.std_m)

    @property
    def error_m(self) -> Array:
        """(L,) error that the estimate of a clip reckons with [m]."""
        # 1.4: Between keyframes errors count as this many times as large: those of neighboring links are
        # alike.
        return 1.4 * self.std_m

    def expected(self, depth: Array) -> Array:
        """(F, L) expected depths of the links by the points' guessed depths (F, N) [m]."""
        return np.asarray(self.gain * self.links.guessed(depth) + self.offset_m)


def read_depths(
    evidence: DepthEvidence,
    model: KeypointModel,
    pose: Pose,
    frame: IndexArray,
    depth: Array,
    posing_std_m: float,
) -> DepthEvidence:
    """The evidence as K posed keyframes have it.

    `depth` (K, N): the points' guessed depths there [m]; `posing_std_m`: error of a posed point [m].
    """
    links = evidence.links
    guessed, true = links.guessed(depth), links.depths(model, pose, frame)
    known = np.isfinite(guessed)
    guess = np.where(known, guessed, 0.0)
    length = links.lengths_m(model)
    usual = (HINT_ERROR * length) ** 2
    posing = 2.0 * posing_std_m**2
    variance, gain, offset = usual.copy(), evidence.gain.copy(), evidence.offset_m.copy()
    names = np.array(links.names)
    for _ in range(4):
        squared = np.zeros_like(guess)
        for i in range(len(names)):
            rows = np.stack([guess[:, i], np.ones(len(guess))], axis=-1) * known[:, i, None]
            noise = variance[i] + posing
            # 0.5: standard deviation of the gain from 1, and of the offset over the link's length
            # 0.2: of the offset, over the link's length
            prior = np.array([0.5, 0.2 * length[i]]) ** -2.0
            information = rows.T @ rows / noise + np.diag(prior)
            wanted = rows.T @ np.where(known[:, i], true[:, i], 0.0) / noise + prior * [1.0, 0.0]
            gain[i], offset[i] = np.linalg.solve(information, wanted)
            left = np.where(known[:, i], true[:, i], 0.0) - rows @ [gain[i], offset[i]]
            doubt = np.sum(rows * np.linalg.solve(information, rows.T).T, axis=-1)
            share = variance[i] / noise  # of what is left that is the guess's, not the keyframe's
            squared[:, i] = share**2 * np.minimum(left**2, LARGEST_ERROR**2 * noise) + share * posing + doubt
        count = known.sum(axis=0)
        total = np.where(known, squared, 0.0).sum(axis=0)
        # 12.0: Numbers of errors that the usual error, and that of a link's name, weigh as much as.
        # 6: a link's own errors
        variance = _pooled(names, usual, total, count, 12.0, 6.0)
    return replace(evidence, gain=gain, offset_m=offset, std_m=np.sqrt(variance))


# --- Keypoints


# Correlation of the places of a point and its mirror image: what one detector calls a hip it does on both
# sides.
MIRRORED = 0.7
NOBODY: Mapping[str, str] = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class KeypointEvidence:
    """The calibrated model of N keypoints, and the trust they deserve."""

    model: KeypointModel  # with the places and the lens found
    sources: tuple[str, ...]  # (N,) what saw each
    std_m: Array  # (N,) error of a sure detection along each axis of the image [m]
    trust: Array  # (N,) 1 for points that are believed, 0 for those left out
    lag: Mapping[str, int]  # by source left out for it: frames late, or early where negative
    depths: DepthEvidence  # what the hints of depth are worth
    together: tuple[tuple[str, str], ...]  # (N,) alike for those that err together
    memory_s: float = 0.15  # time in which an error fades to a third [s]

    @classmethod
    def usual(
        cls,
        body: Body,
        camera: Camera,
        names: tuple[str, ...],
        sources: tuple[str, ...],
        beside: Mapping[str, str] = NOBODY,
    ) -> "KeypointEvidence":
        """Keypoints before any keyframe is posed: usual places and errors; `beside` as in `Keypoints`."""
        model = KeypointModel.usual(body, camera, names)
        depths = DepthEvidence.usual(DepthLinks.between(names, sources), model)
        # Points of one source on one segment, wrist and knuckles, err together: they weigh as much as one.
        # So do those of a network beside it that guesses no depths: its points would outvote the other's.
        places = [USUAL_PLACES[name] for name in names]
        first = [beside.get(source, source) for source in sources]
        together = tuple(zip([place.joint for place in places], first, strict=True))
        count = [together.count(one) for one in together]
        std_m = np.array([place.error_std_m for place in places]) * np.sqrt(count)
        return cls(model, sources, std_m, np.ones(len(names)), {}, depths, together)

    @property
    def error_m(self) -> Array:
        """(N,) error along each axis of the image that the estimate of a clip reckons with [m]."""
        # 3.0: Between keyframes errors count as this many times as large. Those of neighboring points are
        # alike, so that a dozen say as much as half a dozen; and where a limb lies across the view, an error
        # that makes it too short turns it a long way toward or away from the camera, of which a linearised
        # row knows nothing.
        return np.where(self.trust > 0.0, 3.0 * self.std_m, np.inf)

    def errors(self, found_share: Array) -> tuple[Array, Array]:
        """Errors (F, N) that the estimate of a clip reckons with [m], and how long they last (F,) [s].

        Posed keyframes know the motion better than single points do. Found ones (F,) came from these points,
        which are followed then.
        """
        followed_m = np.where(self.trust > 0.0, _followed_std_m(self.model.names, self.together), np.inf)
        error_m = self.error_m ** (1.0 - found_share[:, None]) * followed_m ** found_share[:, None]
        return error_m, self.memory_s ** (1.0 - found_share) * 0.08**found_share


def _followed_std_m(names: tuple[str, ...], together: tuple[tuple[str, str], ...]) -> Array:
    """(N,) error of sure detections where no keyframe is posed, so that a point's place is open too [m].

    Points that err together weigh as much as the surest of them.
    """
    usual = [USUAL_PLACES[name] for name in names]
    own = np.array([np.hypot(one.error_std_m, one.place_std_m) for one in usual])
    for group in set(together):
        same = np.array([one == group for one in together])
        own[same] *= np.sqrt(((own[same].min() / own[same]) ** 2).sum())
    return own


@dataclass(frozen=True, eq=False)
class KnownKeypoints:
    """Keypoints at J frames whose posture is known."""

    pose: Pose  # forward kinematics of the postures
    frame: IndexArray  # (J,) their indices in the clip
    observed: ObservedKeypoints


def keypoint_rows(
    model: KeypointModel, usual: KeypointModel, known: KnownKeypoints, std_m: Array
) -> EvidenceRows:
    """Two rows a keypoint, with three parameters each, its place.

    `model` has the places and the lens found so far, `usual` the usual ones, which parameters count from;
    `std_m` (N,) is the error of a sure detection.
    """
    pixel = model.pixels(known.pose, known.frame)
    by_place = model.place_jacobian(known.pose, known.frame)
    by_posture = model.pixels_jacobian(known.pose, known.frame)
    by_lens = model.lens_jacobian(known.pose, known.frame)
    zoom = float(np.log(usual.camera.lens_mm / model.camera.lens_mm))
    residual = pixel - known.observed.pixel
    residual = residual + (by_place @ (usual.place - model.place)[..., None])[..., 0] + by_lens * zoom
    std_px = _scale(model, known) * std_m / np.maximum(known.observed.confidence, LEAST_CONFIDENCE)
    variance = std_px**2 + PIXEL_STD**2
    usable = np.isfinite(residual).all(axis=-1) & np.isfinite(variance)
    variance = np.broadcast_to(variance[..., None], residual.shape)
    prior = np.linalg.inv(place_covariance(model.names))
    return EvidenceRows.apart(usable, residual, by_place, by_lens, by_posture, variance, prior)


def place_covariance(names: tuple[str, ...]) -> Array:
    """(3 N, 3 N) prior covariance of the places' departure from the usual ones [m²]."""
    count = len(names)
    std = np.array([USUAL_PLACES[name].place_std_m for name in names])
    shared = np.eye(count)
    for first, name in enumerate(names):
        for second, other in enumerate(names):
            if first != second and other == mirrored_point(name):
                shared[first, second] = MIRRORED
    shared *= std[:, None] * std
    covariance = np.zeros((count, 3, count, 3))
    for axis, sign in enumerate((-1.0, 1.0, 1.0)):  # a mirror image is one along x
        covariance[:, axis, :, axis] = np.where(np.eye(count, dtype=bool), shared, sign * shared)
    return covariance.reshape(3 * count, 3 * count)


def learned_std(
    model: KeypointModel, known: KnownKeypoints, usual_m: Array, std_m: Array, left: Array, noise: Array
) -> Array:
    """(N,) error of a sure detection [m] by what is left at the keyframes.

    A step of expectation maximization, in which the rows' error is what is not known.

    `usual_m` and `std_m` (N,) are the usual errors and those so far, `left` (J, 2 N) the rows that the
    calibrated places leave, `noise` (J, 2 N, 2 N) their covariance.
    """
    judged, points = known.observed.confidence.shape
    scale = _scale(model, known) / np.maximum(known.observed.confidence, LEAST_CONFIDENCE)
    own = np.repeat((scale * std_m) ** 2, 2, axis=1)
    inverse = np.linalg.inv(noise)
    mean = own * (inverse @ left[..., None])[..., 0]
    spread = own * np.clip(1.0 - own * np.diagonal(inverse, axis1=1, axis2=2), 0.0, 1.0)
    squared = (mean**2 + spread).reshape(judged, points, 2).sum(-1) / scale**2  # of both axes [m²]
    used = known.observed.seen
    bounded = np.minimum(squared, LARGEST_ERROR**2 * 2.0 * std_m**2)
    total, count = np.where(used, bounded, 0.0).sum(axis=0), 2.0 * used.sum(axis=0)
    stems = np.array([name.partition(".")[0] for name in model.names])
    # 40.0: Numbers of errors that the usual error, and that of a point's name, weigh as much as.
    # 12: a point's own errors
    return np.sqrt(_pooled(stems, usual_m**2, total, count, 40.0, 12.0))


def _pooled(
    names: NDArray[np.str_], usual: Array, total: Array, count: Array, name_count: float, own_count: float
) -> Array:
    """(N,) variances, of which the usual ones weigh as much as so many errors, and those of a name do.

    `total` and `count` (N,): sum of the squared errors, and their number.
    """
    variance = np.empty_like(usual)
    for name in np.unique(names):
        same = names == name
        pooled = (name_count * usual[same].mean() + total[same].sum()) / (name_count + count[same].sum())
        variance[same] = (own_count * pooled + total[same]) / (own_count + count[same])
    return variance


def _scale(model: KeypointModel, known: KnownKeypoints) -> Array:
    """(J, N) pixels of a meter at each point."""
    depth = model.camera.depth(model.world(known.pose), known.frame[:, None])
    return model.camera.pixels_per_meter(depth)
