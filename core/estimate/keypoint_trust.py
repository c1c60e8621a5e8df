"""Which keypoints are believed: those that agree with the keyframes that a person has posed.

A detector may follow another person, lag behind the clip, or see nothing at all. At posed keyframes it is
known where points should be. One that is usually off there by more than a limb's width tells nothing of the
rest either; and where most of a source's points are, or all fit much better some frames earlier or later, the
whole source is left out.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.human import HUMAN, mass_weights
from ..body.kinematics import Pose
from ..body.skeleton import SIDES
from ..camera.camera import Camera
from ..detect.keypoints import Keypoints, People, mirror_images
from ..detect.performer import FITS, person_size, principal_keypoints
from ..numerics.markov_chain import exchanged_path
from ..numerics.robust import DEGREES, multivariate_cost
from ..numerics.vectors import runs
from ..terms.keypoints import HUMAN_LENGTHS_M, USUAL_PLACES, KeypointModel, ObservedKeypoints

LONGEST_LAG = 15  # largest number of frames by which a source is thought to be early or late


@dataclass(frozen=True, eq=False)
class KeypointTrust:
    """What the keyframes say of N keypoints of several sources."""

    trust: Array  # (N,) 1 for points that are believed, 0 for others
    distance_m: Array  # (N,) usual distance across the view from keyframes [m]; NaN where not seen
    lag: Mapping[str, int]  # by source: frames late, or early where negative; 0 for neither


def keypoint_trust(
    model: KeypointModel, sources: tuple[str, ...], points: ObservedKeypoints, pose: Pose, frame: IndexArray
) -> KeypointTrust:
    """Compare keypoints with posed keyframes.

    `points` are those of all F frames, `pose` and `frame` (K,) the posed keyframes'.
    """
    predicted, depth = model.camera.project(model.world(pose), frame[:, None])
    scale = 1.0 / model.camera.pixels_per_meter(depth)
    predicted *= scale[..., None]  # to meters across the view
    at_keyframes = _distances(points, predicted, scale, frame)
    usual = np.array([USUAL_PLACES[name].error_std_m for name in model.names])
    # 0.07: about the half-width of a thigh and the width of an arm [m]
    # 2.0: how many of a point's usual errors are added to it: hands and feet turn
    trust = np.where(at_keyframes > 0.07 + 2.0 * usual, 0.0, 1.0)
    lags = {}
    for source in dict.fromkeys(sources):
        own = np.array([name == source for name in sources])
        principal = own & np.array([name in HUMAN.point_names for name in model.names])
        counted = (principal if principal.any() else own) & np.isfinite(at_keyframes)
        if not counted.any():
            continue
        lags[source] = _lag(points, predicted, scale, frame, counted)
        # 0.5: a source of whose principal points a smaller share is believed is left out
        if lags[source] or trust[counted].mean() < 0.5:
            trust[own] = 0.0
    return KeypointTrust(trust, at_keyframes, lags)


def _distances(points: ObservedKeypoints, predicted: Array, scale: Array, frame: IndexArray) -> Array:
    """(N,) usual distance [m] of the points seen in given frames from what is predicted, (K, N, 2) [m]."""
    distance = np.linalg.norm(points.pixel[frame] * scale[..., None] - predicted, axis=-1)
    usual = np.full(distance.shape[1], np.nan)
    known = np.isfinite(distance).any(axis=0)
    # 0.4: Of the distances at the keyframes: a few that are far off are outliers, of a point that is
    # believed.
    usual[known] = np.nanquantile(distance[:, known], 0.4, axis=0)
    return usual


def _lag(points: ObservedKeypoints, predicted: Array, scale: Array, frame: IndexArray, own: BoolArray) -> int:
    frames, misfit = len(points.pixel), {}
    for lag in range(-LONGEST_LAG, LONGEST_LAG + 1):
        inside = (frame + lag >= 0) & (frame + lag < frames)
        if 2 * inside.sum() >= len(frame):
            found = _distances(points, predicted[inside], scale[inside], frame[inside] + lag)[own]
            if np.isfinite(found).any():
                misfit[lag] = float(np.nanmean(found))
    # 0.03: nearer points are right as they stand [m]
    if misfit.get(0, 0.0) < 0.03:
        return 0
    best = min(misfit, key=lambda lag: misfit[lag])
    # A frame early or late is none.
    # 0.6: A source is early or late if its points' usual distance becomes this share of what it is, or less.
    return best if abs(best) >= 2 and misfit[best] < 0.6 * misfit[0] else 0


# --- Left and right exchanged by a detector


ARMS = ("shoulder", "elbow", "wrist", "index", "thumb", "pinky")
LEGS = ("hip", "knee", "ankle", "heel", "toe", "small_toe")
FACE = ("eye", "ear")  # too near each other to tell: exchanged where arms and legs are
FEWEST_LOOKS = 2  # of the pose network, by which left and right are exchanged


CHANGE = 1.0 / 60.0  # probability that limbs begin or cease to be exchanged, a frame


def find_swaps(
    keypoints: Keypoints, predicted: Array, scale: Array, keyframes: IndexArray, time_s: Array
) -> BoolArray:
    """(F, N) which keypoints are exchanged with their mirror image.

    `predicted` (F, N, 2): where the interpolated keyframes have them [px]; `scale` (F,): pixels of a meter.
    """
    swapped = np.zeros(keypoints.seen.shape, dtype=bool)
    away_s = np.abs(time_s[:, None] - time_s[keyframes]).min(axis=1)
    step_s = np.maximum(np.diff(time_s), 1e-3)
    # 0.04: How far a point is from where its velocity takes it: a detector's jitter, and fast limbs.
    # 40: acceleration of fast limbs [m/s²]
    move_std = np.hypot(0.04, 40.0 * step_s**2)[:, None, None]
    for source in dict.fromkeys(keypoints.sources):
        pairs = [_pairs(keypoints, source, limbs) for limbs in (ARMS, LEGS)]
        if not any(len(own) for own in pairs):
            continue
        exchanged = np.zeros((len(pairs), len(time_s)), dtype=bool)
        for row, own in enumerate(pairs):
            if not len(own):
                continue
            seen, guessed = (
                array[:, own] / scale[:, None, None, None] for array in (keypoints.pixel, predicted)
            )
            speed = _departure_speed(seen - guessed, step_s)
            # 0.04: Error of a point where a keyframe is: the detector's, the posing error, and what places
            # differ by.
            place_std = 0.04 + speed[:, None] * away_s[:, None, None]
            kept = _cost(seen - guessed, place_std)
            other = _cost(seen[:, :, ::-1] - guessed, place_std)
            onward = _extrapolated(seen, step_s)
            stays = _cost(seen[1:] - onward, move_std)
            turns = _cost(seen[1:, :, ::-1] - onward, move_std) - np.log(CHANGE)
            exchanged[row] = exchanged_path(np.stack([kept, other], axis=-1), stays, turns)
        pairs.append(_pairs(keypoints, source, FACE))
        for own, state in zip(pairs, [*exchanged, exchanged.all(axis=0)], strict=True):
            swapped[:, own.ravel()] |= state[:, None]
    return swapped & keypoints.seen


def sided_by_pictures(
    keypoints: Keypoints, people: Sequence[People], height_m: float, time_s: Array
) -> Keypoints:
    """The keypoints with left and right as the pose network sees them in a few pictures, exchanged else.

    A detector follows one person from frame to frame and may have his sides exchanged for long, in a layout
    that is as plausible; the network that looks anew in a picture is not led by what it saw before. Looks at
    somebody else, or at a place from which the camera has turned, tell nothing, and a look alone may err.

    `height_m`: of the performer, by which sizes in the picture are told.
    """
    partner = mirror_images(keypoints.names, keypoints.sources)
    for one in people:
        frames = np.array(sorted(one.in_pictures), dtype=np.intp)
        own = np.array([source == one.source for source in keypoints.sources])
        if not len(frames) or own.sum() != len(one.names):
            continue
        seen = np.full((len(frames), len(own), 2), np.nan)
        seen[:, own] = [one.in_pictures[frame] for frame in frames]
        either = np.stack([keypoints.pixel[frames], keypoints.pixel[frames][:, partner]])
        fits = _apart(either[:, :, own], seen[:, own]).min(axis=0) < FITS
        frames, seen = frames[fits], seen[fits]
        if len(frames) < FEWEST_LOOKS:
            continue
        near = np.abs(np.arange(len(time_s))[:, None] - frames).argmin(axis=1)
        scale = np.full(len(time_s), np.median(person_size(seen[:, own])) / height_m)
        swapped = own & find_swaps(keypoints, seen[near], scale, frames, time_s)
        for column in np.flatnonzero(swapped.any(axis=0)):
            for first, last in runs(swapped[:, column]):
                if np.count_nonzero((frames >= first) & (frames < last)) < FEWEST_LOOKS:
                    swapped[first:last, column] = False
        keypoints = keypoints.exchanged(swapped)
    return keypoints


def _apart(first: Array, second: Array) -> Array:
    """(...) mean distance of points (..., K, 2), in sizes of the second; infinite where none is in both."""
    apart = np.linalg.norm(first - second, axis=-1) / person_size(second)[..., None]
    count = np.isfinite(apart).sum(axis=-1)
    return np.where(count > 0, np.nansum(apart, axis=-1) / np.maximum(count, 1), np.inf)


def doubted_at_changes(keypoints: Keypoints, swapped: BoolArray, time_s: Array) -> Keypoints:
    """The keypoints without their confidence and hints in frames near a change of what is exchanged."""
    doubted = np.zeros_like(swapped)
    for frame in np.flatnonzero((swapped[1:] != swapped[:-1]).any(axis=1)):
        changed = (swapped[frame + 1] != swapped[frame]) & keypoints.seen[[frame, frame + 1]].all(axis=0)
        middle_s = 0.5 * (time_s[frame] + time_s[frame + 1])
        # 0.07: Before and after a change: a detector that follows limbs slides from one to the other for a
        # while.
        doubted |= (np.abs(time_s - middle_s) <= 0.07)[:, None] & changed
    if not doubted.any():
        return keypoints
    return replace(
        keypoints,
        score=np.where(doubted, 0.0, keypoints.score),
        hint_m=np.where(doubted[..., None], np.nan, keypoints.hint_m),
    )


def _pairs(keypoints: Keypoints, source: str, limbs: tuple[str, ...]) -> IndexArray:
    """(P, 2) the left and the right point of each pair that a source has."""
    index = {
        n: i for i, (n, s) in enumerate(zip(keypoints.names, keypoints.sources, strict=True)) if s == source
    }
    found = [
        (index[f"{limb}.L"], index[f"{limb}.R"])
        for limb in limbs
        if f"{limb}.L" in index and f"{limb}.R" in index
    ]
    return np.array(found, dtype=np.intp).reshape(-1, 2)


def _departure_speed(departure: Array, step_s: Array) -> Array:
    """(P,) usual speed [m/s] at which pairs of points (F, P, 2, 2) depart from what is expected."""
    speed = np.linalg.norm(np.diff(departure, axis=0), axis=-1) / step_s[:, None, None]
    # 0.8: quantile of the speeds that is usual
    usual = [
        np.quantile(one[np.isfinite(one)], 0.8) if np.isfinite(one).any() else 0.0
        for one in np.moveaxis(speed, 1, 0)
    ]
    # 0.3: Away from a keyframe it grows with this quantile of the speeds at which points depart from what is
    # interpolated, and at least so fast: a running leg is anywhere a few frames later.
    return np.maximum(np.array(usual), 0.3)


def _extrapolated(seen: Array, step_s: Array) -> Array:
    """(F - 1, P, 2, 2) where the velocities of the frames before take points to from the second frame on."""
    onward = seen[:-1].copy()
    moved = np.diff(seen[:-1], axis=0) * (step_s[1:] / step_s[:-1])[:, None, None, None]
    onward[1:] += np.where(np.isfinite(moved), moved, 0.0)
    return onward


def _cost(error: Array, std: Array) -> Array:
    """(F,) negative logarithm of Student's t of errors (F, P, 2, 2) [m]; what is not seen costs nothing."""
    squared = (error**2).sum(axis=-1) / std**2
    cost = multivariate_cost(squared, DEGREES, 2)
    # 0.5: the points of a limb err alike: each counts as half
    return np.asarray(0.5 * np.nan_to_num(cost).sum(axis=(1, 2)))


# --- Depths that lean


# Share of the balance's lean that is the hints' own: networks take the camera to look down by 4 or 5 degrees
# more or less than it does, and performers are themselves off balance by as much, in the mean of a clip.
HINTS_SHARE = 0.5


def upright(keypoints: Keypoints, camera: Camera) -> Keypoints:
    """The keypoints with their hints turned about the picture's horizontal, so that the body is in balance.

    Over a clip the center of mass is about over the feet, whatever a performer does; where a network has it
    before or behind them, it takes the camera to look down more or less than it does.
    """
    main = principal_keypoints(keypoints)
    # 0.5: of ankles that are seen rather than guessed
    feet_seen = main.score[:, [main.names.index(f"ankle.{side}") for side in SIDES]] > 0.5
    known = np.isfinite(main.hint_m).all(axis=(1, 2)) & main.seen.all(axis=1)
    frame = np.flatnonzero(known & feet_seen.all(axis=1))
    if not len(frame):
        return keypoints
    at = {name: main.hint_m[frame, column] for column, name in enumerate(main.names)}
    _, sight = camera.rays(main.pixel[frame].mean(axis=1), frame)
    across = camera.pose(frame)[0][..., 0]
    across = across - (sight * across).sum(axis=-1, keepdims=True) * sight
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    up = np.stack([across, np.cross(sight, across), sight], axis=-2)[..., 2]  # in the hints' axes
    away = np.array([0.0, 0.0, 1.0]) - up[:, 2:] * up
    left = at["hip.L"] - at["hip.R"] + at["shoulder.L"] - at["shoulder.R"]
    ahead = np.cross(left, up)
    ahead /= np.maximum(np.linalg.norm(ahead, axis=-1, keepdims=True), 1e-6)
    feet = 0.5 * (at["ankle.L"] + at["ankle.R"]) + 0.3 * HUMAN_LENGTHS_M["foot"] * ahead
    center = np.einsum("p,fpi->fi", mass_weights(HUMAN), main.hint_m[frame])
    leans = np.arctan2(((center - feet) * away).sum(axis=-1), ((center - feet) * up).sum(axis=-1))
    lean = float(np.median(leans))
    # 0.26: lean of someone who sits or holds on to something, and is not over the feet
    tilt = HINTS_SHARE * lean if abs(lean) < 0.26 else 0.0
    hint = np.array(keypoints.hint_m)
    down, behind = keypoints.hint_m[..., 1], keypoints.hint_m[..., 2]
    hint[..., 1] = np.cos(tilt) * down - np.sin(tilt) * behind
    hint[..., 2] = np.cos(tilt) * behind + np.sin(tilt) * down
    return replace(keypoints, hint_m=hint)
