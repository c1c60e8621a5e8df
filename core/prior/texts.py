"""Identifiers, names and texts of libraries, checked as untrusted input."""

import re
import unicodedata
from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache, partial
from itertools import count
from typing import Annotated

from ..errors import InputError, shown
from ..files.kinds import Items, Text
from ..files.paths import is_control_character

EVERY_LIBRARY = "auto"  # stands for all libraries where one is named; hence no valid identifier
COMPOSED = "composed"  # stands for parts of several libraries; hence no valid identifier
REFERENCE = "reference motion"  # stands for a motion from elsewhere; no identifier has a space


LONGEST_IDENTIFIER = 64
LONGEST_NAME = 60  # characters of a name at most; the name of a Blender data-block holds 63 bytes
IDENTIFIER_RULE = (
    f"1 to {LONGEST_IDENTIFIER} lower-case letters a to z, digits, dots, hyphens and underscores, the first "
    "and the last of them a letter or digit, with no ending .json, and be no name that Windows keeps for "
    f"devices and not '{EVERY_LIBRARY}' or '{COMPOSED}', which stand for several libraries"
)
_IDENTIFIER = re.compile(r"[a-z0-9]([a-z0-9._-]*[a-z0-9])?", re.ASCII)
_DEVICES = re.compile(r"(con|prn|aux|nul|com[0-9]|lpt[0-9])(\..*)?", re.ASCII)
_FILE = re.compile(r".*\.json", re.ASCII)  # a name like this is a path where a library is named


def is_identifier(text: object) -> bool:
    """Whether a text is a valid identifier; with `.json` it then is a valid file name on every system."""
    return (
        isinstance(text, str)
        and len(text) <= LONGEST_IDENTIFIER
        and text not in (EVERY_LIBRARY, COMPOSED)
        and _IDENTIFIER.fullmatch(text) is not None
        and _DEVICES.fullmatch(text) is None
        and _FILE.fullmatch(text) is None
    )


def checked_identifier(text: object, what: str) -> str:
    """The text, if it is a valid identifier.

    Raises:
        InputError: It is invalid; `what` names it in the sentence.
    """
    if not isinstance(text, str) or not is_identifier(text):
        raise InputError(f"{what} is {shown(text)}; it must have {IDENTIFIER_RULE}")
    return text


def identifier_from(title: str, taken: Iterable[str] = (), otherwise: str = "library") -> str:
    """A valid identifier that resembles a title and is not taken; `otherwise` where it has no letters."""
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode().lower()
    words = re.sub(r"[^a-z0-9]+", "_", plain).strip("_")[: LONGEST_IDENTIFIER - 4].strip("_") or otherwise
    used = set(taken)
    candidates = (words if number == 1 else f"{words}_{number}" for number in range(1, len(used) + 10))
    return next(candidate for candidate in candidates if is_identifier(candidate) and candidate not in used)


def text_fault(text: object, longest: int) -> str:
    """Reason why a line of text is invalid, to follow the word "it"; empty for a valid one."""
    if not isinstance(text, str):
        return "must be a text"
    if len(text) > longest:
        return f"must be a text of at most {longest} characters"
    if not text.strip() or text != text.strip():
        return "must be a text that neither is empty nor begins or ends with a space"
    if any(is_control_character(letter) for letter in text):
        return "must be one line of text without control characters"
    if not name_key(text):
        return "must be a text with visible characters"
    return ""


@lru_cache(maxsize=4096)
def name_key(name: str) -> str:
    """Key that is equal for names people cannot tell apart: by case, Unicode form or hidden characters."""
    folded = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold())
    return " ".join("".join(letter for letter in folded if not is_control_character(letter, "")).split())


def unique_name(name: str, taken: Iterable[str]) -> str:
    """The name, with a number appended if one that looks the same is taken."""
    keys = {name_key(other) for other in taken}
    if name_key(name) not in keys:
        return name
    numbered = (f"{name[: LONGEST_NAME - len(f' {number}')].rstrip()} {number}" for number in count(2))
    return next(candidate for candidate in numbered if name_key(candidate) not in keys)


# --- Kinds of fields


MOST_TAGS = 30
LONGEST_TAG, LONGEST_LICENSE, LONGEST_LINE, LONGEST_TEXT = 40, 100, 200, 2000


def line(longest: int, *, empty: bool = False) -> Text:
    """One line of text, which may be empty or not."""
    return Text(longest, pattern=r"^\S(.*\S)?$", fault=partial(text_fault, longest=longest), empty=empty)


SPDX = replace(
    line(LONGEST_LICENSE),
    valid="an SPDX expression such as CC0-1.0, CC-BY-4.0 or LicenseRef-Proprietary",
    pattern=r"^[A-Za-z0-9.+:() -]+$",
)
Tags = Annotated[tuple[Annotated[str, line(LONGEST_TAG)], ...], Items("texts", 0, MOST_TAGS)]
IDENTIFIER = Text(
    LONGEST_IDENTIFIER,
    f"a text of {IDENTIFIER_RULE}",
    pattern=r"^(?!(auto|composed)$)[a-z0-9]([a-z0-9._-]*[a-z0-9])?$",
    fault=lambda text: "" if is_identifier(text) else f"must have {IDENTIFIER_RULE}",
)
