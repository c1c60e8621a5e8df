"""Base of Keymark's operators, and their reports: sentences with a capital letter."""

from abc import abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ClassVar

import bpy

from ...core.errors import KeymarkError
from .requirements import Requirement, all_met
from .takes import redraw_sidebars_soon


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


@contextmanager
def reported(operator: bpy.types.Operator) -> Iterator[None]:
    """Turn expected failures into the operator's error report.

    In a script Blender raises the report as a RuntimeError. Unexpected failures pass through.
    """
    try:
        yield
        redraw_sidebars_soon()
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        operator.report(
            {"ERROR"},
            f"Keymark needs the Python library {missing}, which is not there; install Keymark from its "
            "package for this platform, which brings it along",
        )
    except KeymarkError as error:
        operator.report({"ERROR"}, capitalized(str(error)))
    except ReferenceError:
        operator.report({"ERROR"}, "An object or a take of this job was removed while it ran; run it again")


class BaseOperator:
    """Mixin of an operator: a subclass lists its requirements and gives `run`."""

    report: Callable[[set[str], str], None]  # Blender's, of the Operator this is mixed into
    requirements: ClassVar[tuple[Requirement, ...]] = ()
    """What must hold before the operator can run; the first that does not becomes the tooltip."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether all requirements are met."""
        return all_met(cls, context, *cls.requirements)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Run; an expected failure becomes the operator's error report, and the operator is cancelled."""
        with reported(self):
            return self.run(context) or {"FINISHED"}
        return {"CANCELLED"}

    @abstractmethod
    def run(self, context: bpy.types.Context) -> set[str] | None:
        """Do the work; return {"CANCELLED"} when nothing was changed, so that Blender adds no undo step."""
