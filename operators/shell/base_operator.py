"""Base of Keymark's operators, and their reports: sentences with a capital letter."""

import os
from abc import abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.types import Context, PropertyGroup

from ...core.errors import InputError, KeymarkError
from ..bridge.keys import keys_changed
from .requirements import Requirement, all_met
from .take_state import TakeState
from .takes import redraw_sidebars_soon


def warn_if_outdated(operator: bpy.types.Operator, take: PropertyGroup) -> None:
    """Warn that a take's final Action, which is about to be used, was baked from an earlier motion."""
    if TakeState(take).final_is_outdated:
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
    except Unchanged as error:
        operator.report({"INFO"}, capitalized(str(error)))
    except KeymarkError as error:
        operator.report({"ERROR"}, capitalized(str(error)))
    except ReferenceError:
        operator.report({"ERROR"}, "An object or a take of this job was removed while it ran; run it again")


def call(operator: Callable[..., set[str]], *how: object, **settings: object) -> set[str]:
    """Call another operator of `bpy.ops`; what it reports as an error becomes a sentence of the caller's.

    Raises:
        InputError: It could not run.
    """
    try:
        return set(operator(*how, **settings))
    except RuntimeError as error:
        raise InputError(str(error).removeprefix("Error: ").strip()) from error


class Unchanged(KeymarkError):  # noqa: N818
    """Raised by an operator that has nothing to do; the sentence is reported, and there is no undo step."""


PREFIX = "KEYMARK_OT_"


class BaseOperator:
    """Mixin of an operator: a subclass lists its requirements and gives `run`.

    `KEYMARK_OT_load_take` is called `keymark.load_take`, and is a step of undo unless it says otherwise.
    """

    bl_idname: str
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    report: Callable[[set[str], str], None]  # Blender's, of the Operator this is mixed into
    requirements: ClassVar[tuple[Requirement, ...]] = ()
    """What must hold before the operator can run; the first that does not becomes the tooltip."""

    def __init_subclass__(cls) -> None:
        """Name the operator after its class."""
        super().__init_subclass__()
        if cls.__name__.startswith(PREFIX):
            cls.bl_idname = f"keymark.{cls.__name__.removeprefix(PREFIX)}"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return all_met(cls, context, *cls.requirements)

    def execute(self, context: Context) -> set[str]:
        """Run; an expected failure becomes the operator's error report, and the operator is cancelled."""
        keys_changed()  # a script may have set some that Blender has called no handler for yet
        with reported(self):
            return self.run(context) or {"FINISHED"}
        return {"CANCELLED"}

    @abstractmethod
    def run(self, context: Context) -> set[str] | None:
        """Do the work; without a change raise `Unchanged`, or return {"CANCELLED"}, for no step of undo."""


def remove_active(owner: PropertyGroup, entries: str, active: str) -> None:
    """Remove the active entry of an owner's list, by the names of both; the one before it becomes active."""
    index = min(getattr(owner, active), len(getattr(owner, entries)) - 1)
    getattr(owner, entries).remove(index)
    setattr(owner, active, max(0, index - 1))


# --- Asking for a file: the browser opens where it was left


_folders: dict[str, str] = {}  # folder that each operator's browser was left in, for this session


def browse(operator: bpy.types.Operator, context: Context, folder: str = "") -> set[str]:
    """Show the file browser where this operator's was left last, first in `folder`; returns as `invoke`."""
    begin = _folders.get(operator.bl_idname, folder)
    if begin:
        operator.filepath = os.path.join(begin, "")
    context.window_manager.fileselect_add(operator)
    return {"RUNNING_MODAL"}


def chosen_path(operator: bpy.types.Operator) -> Path:
    """The path that an operator got from its browser or a script; the folder is kept for the next time."""
    path = Path(bpy.path.abspath(operator.filepath))
    if operator.filepath:
        _folders[operator.bl_idname] = str(path if path.is_dir() else path.parent)
    return path


def chosen_file(operator: bpy.types.Operator, wanted: str) -> Path:
    """The file that an operator got, as `chosen_path`; a script may name a folder of images.

    Raises:
        InputError: Nothing was chosen: a browser then gives its folder and a separator. `wanted` says what
            would be valid.
    """
    path = chosen_path(operator)
    if not operator.filepath:
        raise InputError(f"no file is chosen; choose {wanted}")
    if operator.filepath.endswith(("/", os.sep)):
        raise InputError(f"no file is chosen in {path}; choose {wanted}")
    return path
