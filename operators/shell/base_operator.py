"""Base of Keymark's operators: what they require, and expected failures as error reports."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import bpy

from .error_reports import reported
from .requirements import Requirement, all_met


class BaseOperator:
    """Mixin of an operator: a subclass names what it requires, and gives `run`."""

    report: Callable[[set[str], str], None]  # Blender's, of the Operator this is mixed into
    requirements: ClassVar[tuple[Requirement, ...]] = ()
    """What must be there before the operator can run; the first that is missing becomes the tooltip."""

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
        """Do the work.

        Returns:
            None where it is done; {"CANCELLED"} where there was nothing to do, and so nothing to undo.

        Raises:
            KeymarkError: It could not be done; the sentence is reported.
        """
