"""Options of the paper's filter that the paper leaves open: noise and fuzzy sets, with units."""

from dataclasses import dataclass, field, fields

from ..observation.depths import DEPTH_STD_M
from .fuzzy import Memberships


@dataclass(frozen=True)
class FilterOptions:
    """Noise and sets of the paper's filter; docs/method.md says how each was settled.

    A *natural deviation* is how far a degree of freedom usually lies from a prior interpolated between
    keyframes (`Skeleton.deviations`).

    Raises:
        ValueError: A standard deviation or width is not positive, or the gate's probability not below 1.
    """

    centroid_std_px: float = 1.0
    """Extraction noise of a centroid [px]."""
    centroid_std_widths: float = 0.25
    """How far a region's centroid lies from the middle of its segment's line [segment widths]."""
    angle_std_rad: float = 0.1
    """Noise of the direction of a region as thin as a line [rad]; rounder regions have more."""
    log_ratio_std: float = 1.0
    """Noise of log S_λ: wide, since sleeves and occlusion change the ratio more than the posture does."""
    depth_std_m: float = DEPTH_STD_M
    """Noise of the a priori depths [m]."""
    initial_std: float = 0.5
    """Deviation of the first frame from the prior [natural deviations]."""
    near_width: float = 0.3
    """Half-width of the near rule's output set, a frame's step [natural deviations]."""
    far_width: float = 0.3
    """Half-width of the far rule's output set, a frame's step [natural deviations]."""
    gate_probability: float = 0.999
    """Share of right observations that pass the gate; a marker past it counts for less in that frame."""
    memberships: Memberships = field(default_factory=Memberships)
    """The rules' input sets."""

    def __post_init__(self) -> None:
        """Check the numbers."""
        for option in fields(self):
            value = getattr(self, option.name)
            if option.name != "memberships" and not 0.0 < value < float("inf"):
                raise ValueError(f"{option.name} is {value}; a finite number above 0 is valid")
        if self.gate_probability >= 1.0:
            raise ValueError(
                f"gate_probability is {self.gate_probability}; a number between 0 and 1 is valid"
            )
