"""What must hold before an operator can run, the base of operators, and their reports."""

import os
from abc import abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import ClassVar

import bpy
from bpy.types import Context, Operator, PropertyGroup, Scene

from ...core.errors import InputError, KeymarkError
from ..bridge.actor_bones import is_actor, missing_bones
from ..bridge.footage import is_missing
from ..bridge.keys import keys_changed
from .job_progress import job_is_running
from .take_state import TakeState
from .takes import find_take, redraw_sidebars_soon

Requirement = Callable[[bpy.types.Context, TakeState | None], str | None]
"""Of the context, and the state of the active take; None without a take."""


def of_take(has: Callable[[TakeState], object], otherwise: str) -> Requirement:
    """Something that there must be a take with."""
    return lambda _, state: None if state is not None and has(state) else otherwise


footage = of_take(lambda state: state.take.clip, "Load the footage or open a take first")
camera = of_take(lambda state: state.take.camera, "Choose the camera that the footage was taken with first")
markers = of_take(lambda state: len(state.take.markers), "Add the markers that the performer wears first")
picked_color = of_take(
    lambda state: any(marker.is_picked for marker in state.take.markers), "Pick the color of a marker first"
)
keyframes = of_take(lambda state: state.take.keyframe_action, "Pose the actor and store a keyframe first")
matches = of_take(lambda state: len(state.take.matching.matches), "Find keyframes first (Pose All)")
motion = of_take(lambda state: state.take.motion_action, "Reconstruct the motion first")
keypoint_files = of_take(lambda state: len(state.take.follow.files), "Load keypoints first")


def actor(_context: Context, state: TakeState | None) -> str | None:
    """The take's actor is in the scene and can be edited."""
    if state is not None and state.has_lost_actor:
        return "Bring the deleted actor back first, in the step Performer"
    armature_object = None if state is None else state.actor
    if armature_object is None:
        return "Build the actor first, or choose its armature"
    if not is_actor(armature_object):
        return (
            f"'{armature_object.name}' is no actor of Keymark's, as it lacks "
            f"{', '.join(missing_bones(armature_object)[:3])}; build an actor, and choose "
            f"'{armature_object.name}' in the step Character"
        )
    if armature_object.library is not None:
        return "The actor is linked; make a library override of it first (Object > Library Override)"
    return None


def any_actor(context: Context, state: TakeState | None) -> str | None:
    """The take has an actor, or had one."""
    return None if state is not None and state.has_lost_actor else actor(context, state)


def anything_to_follow(_context: Context, state: TakeState | None) -> str | None:
    """The take follows markers, keypoints, tracks or contours."""
    if state is None or state.has_points or state.has_contours:
        return None  # a take without footage says so itself
    if state.take.follow.use_contours and state.take.camera is not None:
        return "Load keypoints, assign tracks or add markers first: contours need a camera that stands still"
    return "Switch on the contours, load keypoints, assign tracks or add markers first (step Performer)"


def points_to_follow(_context: Context, state: TakeState | None) -> str | None:
    """The take follows markers, keypoints or tracks; contours alone are not enough."""
    if state is None or state.has_points:
        return None
    return "Load keypoints, assign tracks or add markers first; this needs more than contours"


def all_colors(_context: Context, state: TakeState | None) -> str | None:
    """Every marker that is followed has a color."""
    lacking = "Pick the colors of all markers first, or remove those that have none"
    return lacking if state is not None and state.lacks_colors else None


def two_keyframes(context: Context, state: TakeState | None) -> str | None:
    """The take has at least two keyframes, or a motion from elsewhere."""
    if state is not None and state.take.follow.reference and state.take.method == "map":
        return None  # the motion from elsewhere has keyframes of its own
    if state is None or state.take.keyframe_action is None:
        return keyframes(context, state)
    if len(state.keyed.all) == 1:
        keys_changed()  # a script may have set a key for which Blender has called no handler yet
        if len(TakeState(state.take).keyed.all) == 1:
            return "Store a keyframe at another frame first; there is only one"
    return None


def weak_frames(_context: Context, state: TakeState | None) -> str | None:
    """The review found frames worth another keyframe."""
    if state is None or state.take.review.frame_count == 0:
        return "Reconstruct the motion first"
    return None if len(state.take.review.weak_frames) else "No frame needs another keyframe"


def of_context(has: Callable[[Context], object], otherwise: str) -> Requirement:
    """Something that must be so whatever the take."""
    return lambda context, _: None if has(context) else otherwise


def _mode(context: Context) -> str:
    """The mode of the active object; Blender adds objects in Object Mode alone."""
    active = context.view_layer.objects.active
    return "OBJECT" if active is None else active.mode


registered_library = of_context(
    lambda context: len(context.window_manager.keymark_shelf.libraries), "Load a keyframe library first"
)
object_mode_possible = of_context(
    lambda context: _mode(context) == "OBJECT", "Choose Object Mode first, at the top left of the view"
)
bones_editable = of_context(
    lambda context: _mode(context) in ("OBJECT", "POSE"),
    "Choose Object Mode first, at the top left of the view",
)
idle = of_context(
    lambda context: not job_is_running(context),
    "Another of Keymark's jobs is running; wait for it, or stop it with Esc",
)


def all_met(operator_class: type[Operator], context: Context, *requirements: Requirement) -> bool:
    """Whether all requirements are met; the sentence of the first unmet one becomes the tooltip."""
    take = find_take(context.scene)
    state = None if take is None else TakeState(take)
    unmet = next(filter(None, (requirement(context, state) for requirement in requirements)), None)
    if unmet is not None:
        operator_class.poll_message_set(unmet)
    return unmet is None


# --- Base of Keymark's operators, and their reports: sentences with a capital letter


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
    """A sentence of core's as Blender shows it: fields for options, and a capital letter.

    But for sentences that begin with the name of a file or a quote.
    """
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
        _note_missing_clips(bpy.context.scene)
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
