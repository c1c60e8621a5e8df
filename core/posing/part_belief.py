"""X."""
from dataclasses import dataclass
from ..arrays import SingleArray
@dataclass(frozen=True, eq=False)
class PartBelief:
    stance: SingleArray
    limbs: dict[str, SingleArray]
