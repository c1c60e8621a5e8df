"""Reports and labels, from templates that can be translated.

A template is a plain literal in the call, where Blender's tools find it for translators. Values stand in
braces and are filled in after translation.
"""

from typing import Any

import bpy

from ...core.text import Sentence

pgettext_n = bpy.app.translations.pgettext_n
"""Marks a template for Blender's tools where it is kept, in a table say, and translated later."""


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


def warn(operator: bpy.types.Operator, sentence: str) -> str:
    """Report a sentence of core's, or a notice, as a warning; return it as it was shown."""
    text = translated(sentence)
    operator.report({"WARNING"}, text)
    return text


def translated(sentence: str) -> str:
    """Return a sentence of core's, translated, with a capital letter unless it begins with a name.

    What is no `Sentence`, as an error that tells of a file or a note that was stored, stays in English.
    """
    begins = sentence.template if isinstance(sentence, Sentence) else sentence
    text = _translated(sentence)
    return text[:1].upper() + text[1:] if begins.partition(" ")[0].isalpha() else text


def _translated(sentence: str) -> str:
    if not isinstance(sentence, Sentence):
        return str(bpy.app.translations.pgettext_rpt(sentence))  # plain literals are their own templates
    parts = {
        name: _translated(value) if isinstance(value, Sentence) else value
        for name, value in sentence.values.items()
    }
    return str(bpy.app.translations.pgettext_rpt(sentence.template)).format(**parts)


def label(template: str, **values: Any) -> str:
    """Return a translated label; draw it with `translate=False`."""
    return str(bpy.app.translations.pgettext_iface(template)).format(**values)


def tooltip(template: str, **values: Any) -> str:
    """A translated tooltip, for an operator's `description`."""
    return str(bpy.app.translations.pgettext_tip(template)).format(**values)


def count_label(count: int, one: str, many: str) -> str:
    """A line of a panel from one of two templates: `1 posture`, else `{count} postures`."""
    return label(one if count == 1 else many, count=count)
