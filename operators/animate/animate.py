"""The one button, from a clip to a moving character, and the same again from corrected poses."""

from contextlib import suppress
from pathlib import Path

import bpy
from bpy.types import Context, Event, Operator, Scene

from ...core.errors import InputError
from ...core.progress import Job, Progress, stretch
from ..actor.properties import Stature
from ..animate import FILE, NOTHING, RIGIFY
from ..bridge.character.rigify_human import has_rigify
from ..character.characters import candidates
from ..character.retarget import keep_retargeted, retarget_take
from ..finish.bake_motion import bake, keep_baked
from ..follow.load_keypoints import chosen_network, draw_network
from ..footage.load_footage import PATTERNS, load_into_take
from ..footage.properties import Part, draw_part
from ..reconstruct.reconstruct import PreviewedJob, keep_motion, reconstruct_take
from ..shell import need
from ..shell.base_operator import call, chosen_file, reported
from ..shell.fields import HIDDEN, SKIP_SAVE, Choice, File, Switch, Text
from ..shell.panel import draw_sentence
from ..shell.results import EXTENSION
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take

outdated = need.of_take(lambda state: state.is_outdated, "Everything is up to date")


def update_take(operator: PreviewedJob, scene: Scene) -> Job[list[str]]:
    """Make anew what is outdated of the active take, each part in the scene once complete; a line on each."""
    lines = []
    if TakeState(active_take(scene)).motion_is_outdated:
        made, judged = yield from stretch(reconstruct_take(operator, scene), 0.0, 0.6)
        operator.unwatch()  # the motion takes the place of its preview
        lines.append(keep_motion(operator, scene, made, judged))
    if TakeState(active_take(scene)).final_is_outdated:
        lines.append(keep_baked(operator, scene, (yield from stretch(bake(scene), 0.6, 0.7))))
    chosen, count = active_take(scene).active_character, len(active_take(scene).characters)
    for index in range(count):
        take = active_take(scene)
        if any(map(TakeState(take).of_earlier, take.characters[index].results)):
            take.active_character = index
            start, end = (0.7 + 0.3 * at / count for at in (index, index + 1))
            lines.append(
                keep_retargeted(operator, scene, (yield from stretch(retarget_take(scene), start, end)))
            )
    active_take(scene).active_character = chosen
    yield Progress("Updated", 1.0)
    return lines


class StagedOperator(PreviewedJob):
    """Mixin of a job that writes what is complete into the scene on its way, and returns lines on it."""

    def finish(self, scene: Scene, result: list[str]) -> None:
        """Report the lines."""
        for line in result:
            self.report({"INFO"}, line)

    def modal(self, context: Context, event: Event) -> set[str]:
        """An early end is a step that can be undone as well: complete stages stay."""
        done = super().modal(context, event)
        if done != {"CANCELLED"}:
            return done
        self.report({"INFO"}, "The stages that were complete are kept")
        return {"FINISHED"}


class KEYMARK_OT_update(StagedOperator, bpy.types.Operator):
    """Make the motion of your corrections, and bake and retarget it again where that was done before"""

    bl_label = "Update"
    requirements = (outdated, *need.RECONSTRUCTION)

    def start(self, scene: Scene) -> Job[list[str]]:
        return (yield from update_take(self, scene))


# --- *Animate*: asks for a clip, the performer's height and a character, and goes all the way as one job


TURNS = [("AUTO", "Upright", "So that people are upright; MP4 and QuickTime alone")]
TURNS += [
    (str(turn), f"{turn}°" if turn else "As It Is", f"Clockwise by {turn} degrees")
    for turn in (0, 90, 180, 270)
]
CHARACTER_PATTERNS = "*.blend;*.fbx;*.glb;*.gltf;*.vrm"
CLIP, CHARACTER = "CLIP", "CHARACTER"
LAST_FOLDER = "last_clip_folder.txt"
_items: list[tuple[str, str, str, str, int]] = []  # Blender keeps no copy of the strings


def _characters(_operator: Operator, context: Context | None) -> list[tuple[str, str, str, str, int]]:
    """Those in the scene, then a Rigify human, a file, and none at all."""
    there = [] if context is None else candidates(context.scene, context.view_layer)
    rows = [(each.name, each.name, "This armature of the scene", "ARMATURE_DATA") for each in there]
    if has_rigify():
        words = "A Rigify rig of the performer's size; enables the add-on Rigify, which comes with Blender"
        rows.append((RIGIFY, "Rigify Human", words, "OUTLINER_OB_ARMATURE"))
    rows.append((FILE, "From a File", "Asks for the character's file next", "FILE_FOLDER"))
    rows.append((NOTHING, "None", "The performer's armature alone", "X"))
    _items[:] = [(*row, number) for number, row in enumerate(rows)]
    return _items


class KEYMARK_OT_animate(Stature, Part, StagedOperator, bpy.types.Operator):
    """From a clip and the performer's height to a moving character; every step can be corrected afterwards"""

    bl_label = "Animate"
    requirements = (need.bones_editable, need.idle)

    filepath: File("A video, or one image of a numbered sequence")
    character: Choice("Character", "Who performs the motion", items=_characters, options=SKIP_SAVE)
    character_file: Text(
        "Character File",
        "File of the character, and after a colon the name of its armature where it has several",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    turn: Choice("Turn Picture", "By how much the picture is turned first", items=TURNS, options=SKIP_SAVE)
    asking: Text(options={"HIDDEN", "SKIP_SAVE"})
    clip: Text(options={"HIDDEN", "SKIP_SAVE"})
    problem: Text("Problem", "Why what was chosen last cannot be animated", options={"HIDDEN", "SKIP_SAVE"})
    filter_glob: Text(default=PATTERNS, options={"HIDDEN", "SKIP_SAVE"})
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Ask for what is missing, the clip first; then run as a job."""
        if self.filepath and (self.character != FILE or self.character_file):
            return super().invoke(context, event)
        wrong, self.asking = self.clip, CHARACTER if self.filepath else CLIP
        self.clip, self.filter_glob = self.filepath, CHARACTER_PATTERNS if self.filepath else PATTERNS
        if self.asking == CLIP:
            self.filepath = wrong or str(_last_folder() / "_").removesuffix("_")
        else:
            self.filepath = ""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Go on with what the file browser gave, or, without one, run the whole job."""
        if not self.asking:
            return super().execute(context)
        clip, file = (
            (self.filepath, self.character_file) if self.asking == CLIP else (self.clip, self.filepath)
        )
        typed = {one: getattr(self, one) for one in ("stature", "character", "turn", *Part.__annotations__)}
        with reported(self):
            try:
                call(bpy.ops.keymark.animate, "INVOKE_DEFAULT", filepath=clip, character_file=file, **typed)
            except InputError as error:  # once more, with what was typed, and why it cannot be
                call(
                    bpy.ops.keymark.animate, "INVOKE_DEFAULT", clip=self.filepath, problem=str(error), **typed
                )
        return {"CANCELLED"}  # the job is a step of its own

    def draw(self, context: Context) -> None:
        if self.asking == CHARACTER:
            return
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "stature")
        if not self.properties.is_property_set("stature"):
            layout.label(text="Assumed; enter the performer's", icon="INFO")
        if self.problem:
            draw_sentence(layout, context, self.problem, "ERROR")
        layout.prop(self, "character")
        draw_network(layout)
        header, body = layout.panel("KEYMARK_PT_animate_part", default_closed=True)
        header.label(text="Picture and Part")
        if body is not None:
            body.prop(self, "turn")
            draw_part(body, self)

    def start(self, scene: Scene) -> Job[list[str]]:
        """Load the clip, and go on; what is complete stays in the scene where the job ends early."""
        from ...core.take.description import keypoints_beside
        from .stages import animate, follow_found_file, turned_copy

        stature = self.given_stature()
        path = chosen_file(self, "a video, or one image of a numbered sequence")
        # What is wrong with a network is said before anything changes.
        network = chosen_network() if keypoints_beside(path) is None else None
        kept = _folder_file()
        if kept is not None:
            with suppress(OSError, ValueError):
                kept.write_text(str(path.parent), encoding="utf-8")
        if self.turn not in ("AUTO", "0"):
            path = turned_copy(path, int(self.turn))
        there = find_take(scene)
        take = load_into_take(bpy.context, path, there is not None and there.clip is not None)
        for name in Part.__annotations__:
            setattr(take.part, name, getattr(self, name))
        follow_found_file(take, path)
        turns = self.turn == "AUTO"
        return animate(self, scene, stature, self.character, self.character_file, turns, network)


def _folder_file() -> Path | None:
    with suppress(ValueError):  # not installed as an extension
        return Path(bpy.utils.extension_path_user(EXTENSION, create=True)) / LAST_FOLDER
    return None


def _last_folder() -> Path:
    """Where the last clip was, in an earlier session too; else the home folder."""
    file = _folder_file()
    with suppress(OSError, ValueError):
        kept = Path(file.read_text(encoding="utf-8")) if file is not None else Path.home()
        if kept.is_dir():
            return kept
    return Path.home()
