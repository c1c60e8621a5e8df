"""Expected failures as error reports in Blender's status bar."""

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ...core.errors import KeymarkError
from .messages import capitalized
from .redraw import redraw_sidebars_soon


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
