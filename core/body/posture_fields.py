"""Postures as JSON fields: values by name of degree of freedom, in meters and radians."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..files.fields import Fields, listed
from ..files.inherited_fields import child_location
from ..files.json_file import shown
from ..files.kinds import Kind, Number, refuse
from .posture import Posture
from .skeleton import Skeleton

FARTHEST_M = 1000.0
LARGEST_ANGLE_RAD = 4.0 * np.pi
DECIMALS = 6
"""Micrometers and microradians: far below any measurement error, and files stay short."""


def posture_to_json(posture: Posture, decimals: int = DECIMALS) -> dict[str, Any]:
    """A posture, or a batch along the first axis, by name of degree of freedom [m, rad].

    `PostureValues` gives the same numbers back.
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


@dataclass(frozen=True)
class PostureValues(Kind):
    """A single posture: its values by name of degree of freedom, in meters and radians."""

    skeleton: Skeleton
    farthest_m: float = FARTHEST_M
    """Largest distance from the origin along an axis [m]."""
    zeros_left_out: bool = False
    """Whether an absent degree of freedom is zero; else it is an error."""
    decimals: int = DECIMALS

    @property
    def valid(self) -> str:  # type: ignore[override]
        """Follows "it must be"."""
        return f"an object with {listed(self.skeleton.dof_names, 3)}"

    @property
    def numbers(self) -> Mapping[str, Number]:
        """The values by name: meters for locations, radians for angles."""
        place, angle = (
            Number(-self.farthest_m, self.farthest_m),
            Number(-LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD),
        )
        return {name: place if ".location_" in name else angle for name in self.skeleton.dof_names}

    def read(self, value: Any, where: str, name: str) -> Posture:
        """See `Kind`."""
        if not isinstance(value, Mapping):
            refuse(where, name, value, self.valid)
        fields, numbers = Fields(value, child_location(where, name)), self.numbers
        unknown = [one for one in value if one not in numbers]
        if unknown:
            raise InputError(
                f"{fields.where} names the unknown degree of freedom {shown(unknown[0])}; known are "
                f"{listed(numbers)}"
            )
        vector = [
            0.0
            if self.zeros_left_out and dof not in value
            else number.read(fields.required(dof, number.valid), fields.where, dof)
            for dof, number in numbers.items()
        ]
        return Posture.from_vector(self.skeleton, np.asarray(vector))

    def write(self, value: Posture) -> dict[str, float]:
        """See `Kind`."""
        values = posture_to_json(value, self.decimals)
        return {name: one for name, one in values.items() if one or not self.zeros_left_out}
