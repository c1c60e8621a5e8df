"""Control characters: invisible ones, which names and sentences may not hold."""

import unicodedata

CATEGORIES = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Unicode categories: control, formatting (also what turns the direction of writing), surrogates, line
breaks."""
JOINERS = "\u200c\u200d"
"""Zero-width, but letters of several scripts need them between them."""


def is_control_character(character: str, allowed: str = JOINERS) -> bool:
    """Whether a character is invisible, or changes how others are shown."""
    return character not in allowed and unicodedata.category(character) in CATEGORIES


def escape_control_characters(text: str) -> str:
    """A text with its control characters as escapes, for terminals, which would obey them."""
    return "".join(ascii(char)[1:-1] if is_control_character(char) else char for char in text)
