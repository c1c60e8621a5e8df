"""Postures as JSON fields: values by name of degree of freedom, in meters and radians."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..files.fields import Fields, listed
from ..files.json_file import shown
from .posture import Posture
from .skeleton import Skeleton

FARTHEST_M = 1000.0
LARGEST_ANGLE_RAD = 4.0 * np.pi
DECIMALS = 6
"""Micrometers and microradians: far below any measurement error, and files stay short."""


def posture_to_json(posture: Posture, decimals: int = DECIMALS) -> dict[str, Any]:
    """A posture, or a batch along the first axis, by name of degree of freedom [m, rad].

    `read_posture` gives the same numbers back.
    """
    vector = posture.to_vector()  # (..., D)
    # Rounded up past π, half a turn would be read as half a turn the other way.
    turns = vector[..., posture.skeleton.ball_dofs]  # (..., B, 3)
    size = np.linalg.norm(turns, axis=-1, keepdims=True)
    longest = np.pi - 2.0 * 10.0**-decimals
    vector[..., posture.skeleton.ball_dofs] = turns * np.minimum(1.0, longest / np.maximum(size, 1.0))
    return dict(zip(posture.skeleton.dof_names, rounded(np.moveaxis(vector, -1, 0), decimals), strict=True))


def rounded(values: Array, decimals: int = DECIMALS) -> Any:
    """Nested lists of numbers, rounded, with no negative zero."""
    return (np.round(values, decimals) + 0.0).tolist()


def read_posture(
    fields: Fields, skeleton: Skeleton, farthest_m: float = FARTHEST_M, *, zeros_left_out: bool = False
) -> Posture:
    """Read the single posture that `posture_to_json` wrote.

    Args:
        fields: The values by name of degree of freedom.
        skeleton: The skeleton with these degrees of freedom.
        farthest_m: Largest distance from the origin along an axis [m].
        zeros_left_out: Whether an absent degree of freedom counts as zero; else it is an error.

    Raises:
        InputError: A degree of freedom is missing, unknown or out of range.
    """
    unknown = [name for name in fields.values if name not in skeleton.dof_names]
    if unknown:
        names = listed(skeleton.dof_names)
        raise InputError(
            f"{fields.where} names the unknown degree of freedom {shown(unknown[0])}; known are {names}"
        )
    vector = [
        0.0 if zeros_left_out and name not in fields.values else fields.number(name, -limit, limit)
        for name, limit in _bounds(skeleton, farthest_m).items()
    ]
    return Posture.from_vector(skeleton, np.asarray(vector))


def _bounds(skeleton: Skeleton, farthest_m: float) -> Mapping[str, float]:
    """Largest absolute value of each degree of freedom: meters for locations, radians for angles."""
    return {name: farthest_m if ".location_" in name else LARGEST_ANGLE_RAD for name in skeleton.dof_names}
