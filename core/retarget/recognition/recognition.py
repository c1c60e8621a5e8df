"""The result of recognition: a character map, what is doubtful about it, and bones beside it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from ..maps.character_map import CharacterMap


@dataclass(frozen=True)
class Recognition:
    """Roles found for a character's bones."""

    character_map: CharacterMap
    """Roles with confidence and source; of a preset also its controls and settings."""
    doubts: tuple[str, ...] = ()
    """What a person should look at, in sentences without a full stop."""
    preset: str | None = None
    """Identifier of the preset whose names the bones have."""
    extras: Mapping[str, tuple[str, ...]] = field(default_factory=lambda: MappingProxyType({}))
    """By role of hand and foot: bones that lie at its joint and do not hang on it, such as goals of inverse
    kinematics; the motion leaves them behind."""
