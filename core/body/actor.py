"""The performer's segment lengths in meters, by default of average proportions.

Proportions of stature: limbs between the centers of their joints after de Leva (1996), *Adjustments to
Zatsiorsky-Seluyanov's segment inertia parameters*, and Dumas et al. (2007), *Adjustments to McConville et al.
and Young et al. body segment inertial parameters*, women and men alike; all else Drillis & Contini (1966),
*Body Segment Parameters*, as tabulated in Winter, *Biomechanics and Motor Control of Human Movement*.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isclose, isfinite
from types import MappingProxyType
from typing import Annotated

from ..errors import InputError
from ..files.kinds import ByName, Number
from ..files.records import Record, kind_of
from .skeleton import SIDES

_LIMBS = {"upper_arm": 0.156, "forearm": 0.155, "hand": 0.108, "thigh": 0.238, "shin": 0.248, "foot": 0.110}
_SURFACE = {"upper_arm": 0.186, "forearm": 0.146, "thigh": 0.245, "shin": 0.246}
"""Of points that are felt on the skin, which 0.1.0 gave performers whom nobody had measured."""
SHARES_OF_STATURE: Mapping[str, float] = MappingProxyType(
    {
        **{f"{part}.{side}": share for part, share in _LIMBS.items() for side in SIDES},
        **{"shoulder_width": 0.220, "hip_width": 0.115, "trunk": 0.285, "neck_head": 0.135},
    }
)
REQUIRED = tuple(name for name in SHARES_OF_STATURE if not name.startswith(("hand", "foot")))
SHORTEST_M, LONGEST_M = 0.02, 2.0
Segments = Annotated[
    Mapping[str, Annotated[float, Number(SHORTEST_M, LONGEST_M, "m")]],
    ByName("lengths in meters", names=tuple(SHARES_OF_STATURE), needs=REQUIRED),
]


@dataclass(frozen=True)
class Actor(Record):
    """Segment lengths of one performer.

    InputError: A length is missing, unknown, not a number or outside 0.02 to 2 m.
    """

    segments_m: Segments = field(hash=False)
    """Length of every segment [m]; hands and feet follow from the stature where not given."""

    def __post_init__(self) -> None:
        """Check the lengths and add those that follow from stature."""
        lengths = kind_of(Segments).read(dict(self.segments_m), "actor", "segments_m")
        stature = self._stature(lengths)
        whole = {name: lengths.get(name, share * stature) for name, share in SHARES_OF_STATURE.items()}
        object.__setattr__(self, "segments_m", MappingProxyType(whole))

    @staticmethod
    def _stature(lengths: Mapping[str, float]) -> float:
        legs = [f"{part}.{side}" for part in ("thigh", "shin") for side in SIDES]
        return sum(lengths[name] for name in legs) / sum(SHARES_OF_STATURE[name] for name in legs)

    @property
    def stature_m(self) -> float:
        """Stature [m], estimated from the legs by average proportions."""
        return self._stature(self.segments_m)

    @property
    def is_average(self) -> bool:
        """Whether all lengths follow from the stature, so that nobody has measured this performer."""
        earlier = {f"{part}.{side}": share for part, share in _SURFACE.items() for side in SIDES}
        stature = self.segments_m["trunk"] / SHARES_OF_STATURE["trunk"]
        return any(
            all(isclose(self.segments_m[name], share * stature, rel_tol=1e-3) for name, share in own.items())
            for own in (SHARES_OF_STATURE, {**SHARES_OF_STATURE, **earlier})
        )

    @classmethod
    def from_stature(cls, stature_m: float) -> "Actor":
        """An actor of average proportions and the stature `stature_m` [m].

        Raises:
            InputError: The height is not between 0.5 and 3 m.
        """
        if not (isfinite(stature_m) and 0.5 <= stature_m <= 3.0):
            raise InputError(f"actor height is {stature_m} m; a height between 0.5 and 3 m is valid")
        return cls({name: share * stature_m for name, share in SHARES_OF_STATURE.items()})
