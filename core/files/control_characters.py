"""Letters that people cannot see, which have no place in names and sentences."""

import unicodedata

HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Categories: control, formatting (also what turns the direction of writing), halves of characters, line
breaks."""
JOINERS = "\u200c\u200d"
"""Zero-width, but letters of several scripts need them between them."""


def is_hidden(letter: str, allowed: str = JOINERS) -> bool:
    """Whether a letter is one that cannot be seen, or changes how others are."""
    return letter not in allowed and unicodedata.category(letter) in HIDDEN


def seen(text: str) -> str:
    """A text with whatever is hidden in it spelt out, for terminals, which would obey it."""
    return "".join(ascii(letter)[1:-1] if is_hidden(letter) else letter for letter in text)
