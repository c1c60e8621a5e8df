"""The question what to do with a library whose identifier is taken, in an operator's dialog."""

from textwrap import wrap

import bpy

from .conflicts import Conflict

LETTERS = 56
"""In a line of the dialog."""
WIDTH = 420


def draw_question(layout: bpy.types.UILayout, operator: bpy.types.Operator, found: list[Conflict]) -> None:
    """Draw what is there and what comes, and the choice."""
    for conflict in found[:3]:
        column = layout.column(align=True)
        for number, line in enumerate(wrap(conflict.sentence, LETTERS)):
            column.label(text=line, icon="BLANK1" if number else "ERROR", translate=False)
    if len(found) > 3:
        layout.label(text=f"... {len(found)}", icon="BLANK1", translate=False)
    column = layout.column(align=True)
    for choice in ("KEEP", "REPLACE", "MERGE", "BOTH"):
        column.prop_enum(operator, "existing", choice)
