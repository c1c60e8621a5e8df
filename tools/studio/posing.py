"""Posing errors of a person: smaller on the screen than in depth, and partly systematic."""

import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture

ERROR_RMS_M = 0.025
HABIT_SHARE = 0.4
"""Share of the error's variance common to all keyframes, the systematic part."""
ACROSS_M, ALONG_M = 0.008, 0.020
"""Standard deviations of the hips' midpoint, across the line of sight and along it."""
ANGLES_DEG = {
    "pelvis": 2.5,
    "waist": 3.5,
    "neck": 5.0,
    "girdle": 2.5,
    "shoulder": 5.0,
    "elbow": 6.0,
    "forearm": 8.0,
    "hip": 3.0,
    "knee": 5.0,
    "shin": 4.0,
}
SCALINGS = 30


def pose_by_hand(body: Body, exact: Posture, sight: Array, random: np.random.Generator) -> Posture:
    """Postures off by 25 mm RMS over keyframes and principal points, with every length kept.

    Args:
        body: The performer.
        exact: The true postures of K keyframes.
        sight: (3,) unit direction of the camera's view.
        random: Source of the errors.
    """
    deviations = _deviations(body)
    keyframes = exact.batch[0]
    habit = random.standard_normal(body.skeleton.dof_count)
    slips = random.standard_normal((keyframes, body.skeleton.dof_count))
    error = np.sqrt(HABIT_SHARE) * habit + np.sqrt(1.0 - HABIT_SHARE) * slips
    along = error[:, :3] @ sight
    error *= deviations
    error[:, :3] += along[:, None] * (ALONG_M - ACROSS_M) * sight
    return exact.plus(_scale(body, exact, error) * error)


def _scale(body: Body, exact: Posture, error: Array) -> float:
    """The factor that scales the errors to the RMS wanted, by bisection, since the RMS grows with it."""
    truth = body.points(body.pose(exact))
    lower, upper = 0.0, 4.0
    for _ in range(SCALINGS):
        middle = 0.5 * (lower + upper)
        posed = body.points(body.pose(exact.plus(middle * error)))
        rms = np.sqrt(np.mean(np.sum((posed - truth) ** 2, axis=-1)))
        lower, upper = (middle, upper) if rms < ERROR_RMS_M else (lower, middle)
    return 0.5 * (lower + upper)


def _deviations(body: Body) -> Array:
    values = []
    for name in body.skeleton.dof_names:
        joint, _, component = name.partition(".")
        values.append(ACROSS_M if "location" in component else np.radians(ANGLES_DEG[joint]))
    return np.array(values)
