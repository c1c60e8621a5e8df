"""Recognition of a character's bones: names as tokens, topology and geometry, weighed together."""

from .recognition import Recognition
from .recognize import recognize

__all__ = ["Recognition", "recognize"]
