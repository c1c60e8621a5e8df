"""The motion that a network guesses by itself, put where the keyframes are."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp
from takes import load_project
from trials import Trial

load_project()

from keymark.core.arrays import Array, BoolArray  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.detect.keypoints import Keypoints  # noqa: E402

HEAD = ("ear.L", "ear.R")
"""Points whose middle is the head, for detectors that show none."""


def aligned_network_points(trial: Trial, keypoints: Keypoints) -> Array | None:
    """The network's 13 points (F, 13, 3) [m] of every frame; None where it guesses too few.

    At each keyframe turn, scale and place are those of the least squares (Umeyama 1991, *Least-squares
    estimation of transformation parameters between two point patterns*); between keyframes they are
    interpolated, and outside held.
    """
    guessed = _principal(keypoints)
    posed = np.array(trial.take.keyframe_indices)
    if guessed is None or len(posed) < 2:
        return None
    filled = _filled(guessed)
    body = trial.take.body
    known = np.stack([body.points(body.pose(keyframe.posture)) for keyframe in trial.take.keyframes])
    fits = [_similarity(filled[index], points) for index, points in zip(posed, known, strict=True)]
    frames = np.clip(np.arange(len(filled)), posed[0], posed[-1])
    turn = Slerp(posed, Rotation.from_matrix(np.stack([fit[0] for fit in fits])))(frames).as_matrix()
    scale = np.interp(frames, posed, [fit[1] for fit in fits])
    place = np.stack([np.interp(frames, posed, [fit[2][axis] for fit in fits]) for axis in range(3)], axis=-1)
    return scale[:, None, None] * filled @ np.swapaxes(turn, -1, -2) + place[:, None]


def _principal(keypoints: Keypoints) -> Array | None:
    """(F, 13, 3) guesses of the principal points in axes with y up; NaN where missing."""
    columns = []
    for name in HUMAN.point_names:
        wanted = (name,) if name in keypoints.names else HEAD if name == "head" else ()
        if not wanted or any(one not in keypoints.names for one in wanted):
            return None
        columns.append(np.mean([keypoints.hint_m[:, keypoints.names.index(one)] for one in wanted], axis=0))
    guessed = np.stack(columns, axis=1) * np.array([1.0, -1.0, -1.0])
    return guessed if _known(guessed).sum() >= 2 else None


def _known(guessed: Array) -> BoolArray:
    return np.asarray(np.isfinite(guessed).all(axis=(1, 2)))


def _filled(guessed: Array) -> Array:
    """Frames without a guess interpolated between their neighbors."""
    known = np.flatnonzero(_known(guessed))
    frames = np.arange(len(guessed))
    flat = guessed.reshape(len(guessed), -1)
    columns = [np.interp(frames, known, flat[known, column]) for column in range(flat.shape[1])]
    return np.stack(columns, axis=-1).reshape(guessed.shape)


def _similarity(points: Array, wanted: Array) -> tuple[Array, float, Array]:
    """Turn (3, 3), scale and place (3,) of the least squares that bring points (13, 3) to wanted ones."""
    middle, goal = points.mean(axis=0), wanted.mean(axis=0)
    left, strength, right = np.linalg.svd((wanted - goal).T @ (points - middle))
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    turn = left @ mirror @ right
    scale = float(np.sum(strength * np.diag(mirror)) / np.sum((points - middle) ** 2))
    return turn, scale, goal - scale * turn @ middle
