"""Left and right exchanged by a detector: a hypothesis to test, not an outlier to average.

A hidden Markov model for each source over four states: nothing exchanged, the arms, the legs, or both
(Rabiner 1989, *A tutorial on hidden Markov models*). A state is held against where the keyframes have the
limbs, which says much near them and little midway, and against how the points move on from frame to frame:
limbs that pass each other keep their velocities, where an exchange makes both turn about. The most probable
sequence is Viterbi's.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..footage.keypoints.body_points import mirror_images
from ..footage.keypoints.keypoints import Keypoints
from ..numerics.robust import multivariate_cost
from .terms.term import DEGREES

ARMS = ("shoulder", "elbow", "wrist", "index", "thumb", "pinky")
LEGS = ("hip", "knee", "ankle", "heel", "toe", "small_toe")
FACE = ("eye", "ear")
"""Too near each other to tell: exchanged where arms and legs are."""
STATES = np.array([[False, False], [True, False], [False, True], [True, True]])
"""Whether arms, and whether legs, are exchanged."""
PLACE_STD_M = 0.04
"""Error of a point where a keyframe is: the detector's, the posing error, and what places differ by."""
LEAST_SPEED_M_PER_S, SPEED_QUANTILE = 0.3, 0.8
"""Away from a keyframe it grows with this quantile of the speeds at which points depart from what is
interpolated, and at least so fast: a running leg is anywhere a few frames later."""
JITTER_STD_M, ACCELERATION_M_PER_S2 = 0.04, 40.0
"""How far a point is from where its velocity takes it: a detector's jitter, and fast limbs."""
ALIKE = 0.5
"""The points of a limb err alike: each counts as half."""
CHANGE = 1.0 / 60.0
"""Probability that limbs begin or cease to be exchanged, a frame."""
SLIDING_S = 0.07
"""Before and after a change: a detector that follows limbs slides from one to the other for a while."""


def find_swaps(
    keypoints: Keypoints, predicted: Array, scale: Array, keyframes: IndexArray, time_s: Array
) -> BoolArray:
    """(F, N) which keypoints are exchanged with their mirror image.

    Args:
        keypoints: The performer's.
        predicted: (F, N, 2) where the interpolated keyframes have them [px].
        scale: (F,) pixels of a meter on the performer.
        keyframes: (K,) frames of the keyframes.
        time_s: (F,) times of the frames [s].
    """
    swapped = np.zeros(keypoints.seen.shape, dtype=bool)
    away_s = np.abs(time_s[:, None] - time_s[keyframes]).min(axis=1)
    step_s = np.maximum(np.diff(time_s), 1e-3)
    move_std = np.hypot(JITTER_STD_M, ACCELERATION_M_PER_S2 * step_s**2)[:, None, None]
    for source in dict.fromkeys(keypoints.sources):
        pairs = [_pairs(keypoints, source, limbs) for limbs in (ARMS, LEGS)]
        if not any(len(own) for own in pairs):
            continue
        place, move = (
            np.zeros((len(time_s), len(STATES))),
            np.zeros((len(time_s) - 1, len(STATES), len(STATES))),
        )
        for own, exchanged in zip(pairs, STATES.T, strict=True):
            if not len(own):
                continue
            seen, guessed = (
                array[:, own] / scale[:, None, None, None] for array in (keypoints.pixel, predicted)
            )
            speed = _departure_speed(seen - guessed, step_s)
            place_std = PLACE_STD_M + speed[:, None] * away_s[:, None, None]
            kept = _cost(seen - guessed, place_std)
            other = _cost(seen[:, :, ::-1] - guessed, place_std)
            place += np.where(exchanged, other[:, None], kept[:, None])
            onward = _extrapolated(seen, step_s)
            stays = _cost(seen[1:] - onward, move_std)
            turns = _cost(seen[1:, :, ::-1] - onward, move_std)
            differs = exchanged[:, None] != exchanged
            move += np.where(differs, (turns - np.log(CHANGE))[:, None, None], stays[:, None, None])
        exchanged = STATES[_most_probable(place, move)]  # (F, 2)
        pairs.append(_pairs(keypoints, source, FACE))
        for own, state in zip(pairs, [*exchanged.T, exchanged.all(axis=1)], strict=True):
            swapped[:, own.ravel()] |= state[:, None]
    return swapped & keypoints.seen


def exchanged_back(keypoints: Keypoints, swapped: BoolArray) -> Keypoints:
    """The keypoints with those of `swapped` (F, N) exchanged with their mirror image's."""
    if not swapped.any():
        return keypoints
    partner = mirror_images(keypoints.names, keypoints.sources)
    either = swapped | swapped[:, partner]
    return replace(
        keypoints,
        pixel=np.where(either[..., None], keypoints.pixel[:, partner], keypoints.pixel),
        score=np.where(either, keypoints.score[:, partner], keypoints.score),
        hint_m=np.where(either[..., None], keypoints.hint_m[:, partner], keypoints.hint_m),
    )


def doubted_at_changes(keypoints: Keypoints, swapped: BoolArray, time_s: Array) -> Keypoints:
    """The keypoints without their confidence and hints in frames near a change of what is exchanged.

    Args:
        keypoints: The performer's, exchanged back.
        swapped: (F, N) which of them were exchanged.
        time_s: (F,) times of the frames [s].
    """
    doubted = np.zeros_like(swapped)
    for frame in np.flatnonzero((swapped[1:] != swapped[:-1]).any(axis=1)):
        changed = (swapped[frame + 1] != swapped[frame]) & keypoints.seen[[frame, frame + 1]].all(axis=0)
        middle_s = 0.5 * (time_s[frame] + time_s[frame + 1])
        doubted |= (np.abs(time_s - middle_s) <= SLIDING_S)[:, None] & changed
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
    usual = [
        np.quantile(one[np.isfinite(one)], SPEED_QUANTILE) if np.isfinite(one).any() else 0.0
        for one in np.moveaxis(speed, 1, 0)
    ]
    return np.maximum(np.array(usual), LEAST_SPEED_M_PER_S)


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
    return np.asarray(ALIKE * np.nan_to_num(cost).sum(axis=(1, 2)))


def _most_probable(place: Array, move: Array) -> IndexArray:
    """(F,) the sequence of states of least cost; `place` (F, S), `move` (F - 1, S, S) from row to column."""
    best, came = place[0], np.zeros(place.shape, dtype=np.intp)
    for frame in range(1, len(place)):
        total = best[:, None] + move[frame - 1]
        came[frame] = total.argmin(axis=0)
        best = total.min(axis=0) + place[frame]
    state = np.empty(len(place), dtype=np.intp)
    state[-1] = best.argmin()
    for frame in range(len(place) - 1, 0, -1):
        state[frame - 1] = came[frame, state[frame]]
    return state
