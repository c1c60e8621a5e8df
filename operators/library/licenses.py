"""Terms under which libraries are usually shared, offered where somebody types a license."""

import bpy

USUAL = (
    ("CC0-1.0", "Anything, without naming anybody"),
    ("CC-BY-4.0", "Anything, the author is named"),
    ("CC-BY-SA-4.0", "Anything under the same terms, the author is named"),
    ("CC-BY-NC-4.0", "Nothing commercial, the author is named"),
    ("LicenseRef-Proprietary", "Nothing without asking"),
)
"""SPDX identifiers, and what others may do."""


def suggest(_properties: bpy.types.AnyType, _context: bpy.types.Context, typed: str) -> list[tuple[str, str]]:
    """The usual licenses that go with what is typed so far, each with what it allows."""
    return [each for each in USUAL if typed.lower() in each[0].lower()] or list(USUAL)
