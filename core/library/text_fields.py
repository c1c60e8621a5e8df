"""Texts, lists and licenses among the fields of files that people share, checked as untrusted input."""

from dataclasses import replace
from functools import partial
from typing import Annotated

from ..files.kinds import Items, Text
from .texts import IDENTIFIER_RULE, LONGEST_IDENTIFIER, is_identifier, text_fault

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
