"""Texts, lists and licenses among the fields of files that people share, checked as untrusted input."""

import re

from ..errors import InputError
from ..files.fields import Fields
from ..files.json_file import shown
from .texts import text_fault

MOST_TAGS = 30
LONGEST_TAG, LONGEST_LICENSE, LONGEST_LINE, LONGEST_TEXT = 40, 100, 200, 2000
SPDX = re.compile(r"[A-Za-z0-9.+:() -]+", re.ASCII)


def text_line(fields: Fields, name: str, longest: int) -> str:
    """One line of text that must be present."""
    text = fields.required(name, f"a text of at most {longest} characters")
    fault = text_fault(text, longest)
    if fault:
        raise InputError(f"{fields.where}: {name} is {shown(text)}; it {fault}")
    return str(text)


def optional_line(fields: Fields, name: str, longest: int) -> str:
    """One line of text; empty where it is empty or missing."""
    return "" if fields.values.get(name, "") == "" else text_line(fields, name, longest)


def text_lines(fields: Fields, name: str, most: int, longest: int) -> tuple[str, ...]:
    """A list of lines of text; empty where it is missing."""
    if name not in fields.values:
        return ()
    lines = []
    for index, text in enumerate(item_list(fields, name, "texts", 0, most)):
        fault = text_fault(text, longest)
        if fault:
            raise InputError(f"{fields.where}: {name}[{index}] is {shown(text)}; it {fault}")
        lines.append(str(text))
    return tuple(lines)


def item_list(fields: Fields, name: str, of_what: str, least: int, most: int) -> list[object]:
    """A list of `least` to `most` items of any kind; `of_what` names them in the plural."""
    valid = f"a list of {least} to {most} {of_what}" if least else f"a list of at most {most} {of_what}"
    items = fields.required(name, valid)
    if not isinstance(items, list):
        raise InputError(f"{fields.where}: {name} is {shown(items)}; it must be {valid}")
    if not least <= len(items) <= most:
        raise InputError(f"{fields.where}: {name} has {len(items)} of them; it must be {valid}")
    return items


def object_list(fields: Fields, name: str, of_what: str, least: int, most: int) -> list[Fields]:
    """A list of `least` to `most` objects."""
    items = item_list(fields, name, of_what, least, most)
    return [Fields.of(item, f"{fields.where}: {name}[{index}]") for index, item in enumerate(items)]


def license_expression(fields: Fields, name: str = "license") -> str:
    """A license as an SPDX expression."""
    text = text_line(fields, name, LONGEST_LICENSE)
    if not SPDX.fullmatch(text):
        raise InputError(
            f"{fields.where}: {name} is {shown(text)}; it must be an SPDX expression such as CC0-1.0, "
            "CC-BY-4.0 or LicenseRef-Proprietary"
        )
    return text
