"""Common licenses of libraries, suggested in license fields."""

import bpy

USUAL = (
    ("CC0-1.0", "Anything, without naming anybody"),
    ("CC-BY-4.0", "Anything, the author is named"),
    ("CC-BY-SA-4.0", "Anything under the same terms, the author is named"),
    ("CC-BY-NC-4.0", "Nothing commercial, the author is named"),
    ("LicenseRef-Proprietary", "Nothing without asking"),
)
"""SPDX identifiers, and what they allow."""


def suggest(_properties: bpy.types.AnyType, _context: bpy.types.Context, typed: str) -> list[tuple[str, str]]:
    """The common licenses that contain the typed text, each with what it allows; all if none does."""
    fitting = [each for each in USUAL if typed.lower() in each[0].lower()] or USUAL
    return [(license, allowed) for license, allowed in fitting]
