"""The base of operators, their reports, and asking for a file."""

import os
from abc import abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.types import Context, Operator, PropertyGroup, Scene

from ...core.errors import InputError, KeymarkError
from ..bridge.footage import is_missing
from ..bridge.keys import keys_changed
from . import need
from .take_state import TakeState
from .takes import find_take, redraw_sidebars_soon


def all_met(operator_class: type[Operator], context: Context, *requirements: need.Requirement) -> bool:
    """Whether all requirements are met; the sentence of the first unmet one becomes the tooltip."""
    take = find_take(context.scene)
    state = None if take is None else TakeState(take)
    unmet = next(filter(None, (requirement(context, state) for requirement in requirements)), None)
    if unmet is not None:
        operator_class.poll_message_set(unmet)
    return unmet is None


def warn_if_outdated(operator: Operator, take: PropertyGroup) -> None:
    """Warn that a take's final Action, which is about to be used, was baked from an earlier motion."""
    if TakeState(take).final_is_outdated:
        operator.report({"WARNING"}, "The final Action is of an earlier motion; bake it again for the newest")


def warn(operator: Operator, sentence: str) -> str:
    """Report a sentence of core's, or a notice, as a warning; return it as it was shown."""
    text = capitalized(sentence)
    operator.report({"WARNING"}, text)
    return text


FIELDS = {
    "--frames": "Part of the Clip (in Picture and Part)",
    "--performer": "Performer (in Picture and Part)",
    "--rotate": "Turn Picture (in Picture and Part)",
    "--keyframes auto": "Pose All",
    "mend --action": "the field Action",
    "mend --subject": "the field Armature",
}
"""What options of the command line, as sentences of core's have them, are called in Blender."""


def capitalized(sentence: str) -> str:
    """A sentence of core's with fields for options, and a capital letter if it begins with a word."""
    for option, field in FIELDS.items():
        sentence = sentence.replace(option, field)
    return sentence[:1].upper() + sentence[1:] if sentence.partition(" ")[0].isalpha() else sentence


def _note_missing_clips(scene: Scene) -> None:
    """Note which clips are not there: they may have been moved while the file is open."""
    settings = getattr(scene, "keymark", None) if scene.library is None else None
    for take in settings.takes if settings else ():
        take.clip_state.missing = is_missing(take.clip)


@contextmanager
def reported(operator: Operator) -> Iterator[None]:
    """Turn expected failures into the operator's error report, which Blender raises in scripts."""
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
        _note_missing_clips(bpy.context.scene)
        operator.report({"ERROR"}, capitalized(str(error)))
    except ReferenceError:
        operator.report({"ERROR"}, "An object or a take of this job was removed while it ran; run it again")


def call(operator: Callable[..., set[str]], *how: object, **settings: object) -> set[str]:
    """Call an operator of `bpy.ops`; what it reports as an error becomes the InputError of the caller."""
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
    requirements: ClassVar[tuple[need.Requirement, ...]] = ()
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


def operator(
    label: str, *requirements: need.Requirement, undo: bool = True
) -> Callable[[Callable[..., set[str] | None]], type[Operator]]:
    """Decorator that makes an operator of a function of itself, the context and the active take, if any.

    The function's name becomes the operator's, and its docstring the tooltip.
    """

    def made(run: Callable[..., set[str] | None]) -> type[Operator]:
        contents = {
            "__doc__": run.__doc__,
            "__module__": run.__module__,
            "bl_label": label,
            "bl_options": BaseOperator.bl_options if undo else {"REGISTER"},
            "requirements": requirements,
            "run": lambda self, context: run(self, context, find_take(context.scene)),
        }
        return type(f"{PREFIX}{run.__name__}", (BaseOperator, Operator), contents)

    return made


def remove_active(owner: PropertyGroup, entries: str, active: str) -> None:
    """Remove the active entry of an owner's list, by the names of both; the one before it becomes active."""
    index = min(getattr(owner, active), len(getattr(owner, entries)) - 1)
    getattr(owner, entries).remove(index)
    setattr(owner, active, max(0, index - 1))


_folders: dict[str, str] = {}  # folder that each operator's browser was left in, for this session


def browse(operator: Operator, context: Context, folder: str = "") -> set[str]:
    """Show the file browser where this operator's was left last, first in `folder`; returns as `invoke`."""
    begin = _folders.get(operator.bl_idname, folder)
    if begin:
        operator.filepath = os.path.join(begin, "")
    context.window_manager.fileselect_add(operator)
    return {"RUNNING_MODAL"}


def chosen_path(operator: Operator) -> Path:
    """The path that an operator got from its browser or a script; the folder is kept for the next time."""
    path = Path(bpy.path.abspath(operator.filepath))
    if operator.filepath:
        _folders[operator.bl_idname] = str(path if path.is_dir() else path.parent)
    return path


def chosen_file(operator: Operator, wanted: str) -> Path:
    """The file, or folder of images, that an operator got; InputError with what is `wanted` if none."""
    path = chosen_path(operator)
    if not operator.filepath:
        raise InputError(f"no file is chosen; choose {wanted}")
    if operator.filepath.endswith(("/", os.sep)):
        raise InputError(f"no file is chosen in {path}; choose {wanted}")
    return path
