"""Reports of operators: notes of core and errors, as sentences with a capital letter."""

import bpy


def warn_if_outdated(operator: bpy.types.Operator, take: bpy.types.PropertyGroup) -> None:
    """Warn that a take's final Action, which is about to be used, was baked from an earlier motion."""
    if take.finish.action is not None and take.finish.outdated:
        operator.report({"WARNING"}, "The final Action is of an earlier motion; bake it again for the newest")


def warn(operator: bpy.types.Operator, sentence: str) -> str:
    """Report a sentence of core's, or a notice, as a warning; return it as it was shown."""
    text = capitalized(sentence)
    operator.report({"WARNING"}, text)
    return text


def capitalized(sentence: str) -> str:
    """A sentence with a capital letter, unless it begins with the name of a file or a quote."""
    return sentence[:1].upper() + sentence[1:] if sentence.partition(" ")[0].isalpha() else sentence
