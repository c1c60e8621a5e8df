"""Sentences for people, from templates that can be translated.

A template is a plain literal where it is said, so that Blender's own tools find it for translators; what
varies stands in braces and is filled in after translation.
"""

from typing import Any

import bpy


def say(operator: bpy.types.Operator, kind: str, template: str, **values: Any) -> None:
    """Report a sentence.

    Args:
        operator: Whose report it is.
        kind: INFO, WARNING or ERROR; in a script, ERROR becomes a RuntimeError.
        template: The sentence, with what varies in braces.
        values: What goes into the braces.
    """
    operator.report({kind}, bpy.app.translations.pgettext_rpt(template).format(**values))


def warn_if_outdated(operator: bpy.types.Operator, take: bpy.types.PropertyGroup) -> None:
    """Say so where a take's final Action, which goes out, was made from an earlier motion."""
    if take.finish.action is not None and take.finish.outdated:
        say(operator, "WARNING", "The final Action is of an earlier motion; bake it again for the newest")


def label(template: str, **values: Any) -> str:
    """A line of a panel; draw it with `translate=False`, as it is translated already."""
    return str(bpy.app.translations.pgettext_iface(template)).format(**values)


def count_label(count: int, one: str, many: str) -> str:
    """A line of a panel from one of two templates: `1 posture`, else `{count} postures`."""
    return label(one if count == 1 else many, count=count)
