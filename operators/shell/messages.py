"""Reports and labels, from templates that can be translated.

A template is a plain literal in the call, where Blender's tools find it for translators. Values stand in
braces and are filled in after translation.
"""

from typing import Any

import bpy


def say(operator: bpy.types.Operator, kind: str, template: str, **values: Any) -> None:
    """Report a sentence in the status bar.

    Args:
        operator: The operator that reports it.
        kind: INFO, WARNING or ERROR; in a script, ERROR becomes a RuntimeError.
        template: The sentence, with values in braces.
        values: The values, by name.
    """
    operator.report({kind}, bpy.app.translations.pgettext_rpt(template).format(**values))


def warn_if_outdated(operator: bpy.types.Operator, take: bpy.types.PropertyGroup) -> None:
    """Warn that a take's final Action, which is about to be used, was baked from an earlier motion."""
    if take.finish.action is not None and take.finish.outdated:
        say(operator, "WARNING", "The final Action is of an earlier motion; bake it again for the newest")


def label(template: str, **values: Any) -> str:
    """Return a translated label; draw it with `translate=False`."""
    return str(bpy.app.translations.pgettext_iface(template)).format(**values)


def count_label(count: int, one: str, many: str) -> str:
    """A line of a panel from one of two templates: `1 posture`, else `{count} postures`."""
    return label(one if count == 1 else many, count=count)
