"""The question what to do with a library whose identifier is taken, in an operator's dialog."""

from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING

import bpy

from ..shell.messages import label

if TYPE_CHECKING:
    from ...core.library.library import Library

CHOICES = [
    ("ASK", "Ask", "Change nothing where another library of the same identifier is there"),
    ("KEEP", "Keep Mine", "Leave the existing library as it is, and the new one out"),
    ("REPLACE", "Replace", "Replace the existing library by the new one"),
    ("MERGE", "Add What Is New", "Add postures and motions that mine lacks; what both have stays mine"),
    ("BOTH", "Keep Both", "Give the new one an identifier of its own, and keep it beside the other"),
]
"""Items of an operator's property: what to do with a library whose identifier is taken."""
LETTERS = 56
"""In a line of the dialog."""
WIDTH = 420


@dataclass(frozen=True, eq=False)
class Conflict:
    """A library that arrives, and a different one that is there under its identifier."""

    new: "Library"
    there: "Library"

    @property
    def sentence(self) -> str:
        """Titles, versions and authors of both, to decide by."""
        new, there = self.new, self.there
        if new.version > there.version:
            age = label("which is newer")
        elif new.version < there.version:
            age = label("which is older")
        else:
            age = label("which is of the same version, but not the same")
        return label(
            "'{title}' ({identifier}) is there in version {version} by {author}; this is version "
            "{new_version} by {new_author}, {age}",
            title=there.title,
            identifier=there.identifier,
            version=there.version,
            author=there.author,
            new_version=new.version,
            new_author=new.author,
            age=age,
        )


def draw_question(layout: bpy.types.UILayout, operator: bpy.types.Operator, found: list[Conflict]) -> None:
    """Draw up to three conflicts, and the choice."""
    for conflict in found[:3]:
        column = layout.column(align=True)
        for number, line in enumerate(wrap(conflict.sentence, LETTERS)):
            column.label(text=line, icon="BLANK1" if number else "ERROR", translate=False)
    if len(found) > 3:
        layout.label(text=f"... {len(found)}", icon="BLANK1", translate=False)
    column = layout.column(align=True)
    for choice in ("KEEP", "REPLACE", "MERGE", "BOTH"):
        column.prop_enum(operator, "existing", choice)
