"""What was measured of a retargeted motion, in a few plain lines."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..bridge.character.retarget import Retargeted


def figures(retargeted: "Retargeted") -> list[str]:
    """Lines on feet, floor, hands and keys."""
    return []
