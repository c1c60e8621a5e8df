"""Base of Keymark's operators: requirements before they run, expected failures as error reports."""

from abc import abstractmethod
from collections.abc import Callable
from typing import ClassVar

import bpy

from .error_reports import reported
from .requirements import Requirement, all_met


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
        """Do the work.

        Returns:
            None when done; {"CANCELLED"} when nothing was changed, so that Blender adds no undo step.

        Raises:
            KeymarkError: The work failed; its sentence is reported.
        """
