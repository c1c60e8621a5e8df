"""The scene's list of takes: one added for another performer, removed, and saved."""

from collections.abc import Iterator
from pathlib import Path

import bpy
from bpy.types import ID, Context, Event, Operator, PropertyGroup

from ...core.errors import InputError
from ...core.progress import run
from ..follow.evidence import add_keypoint_file, keypoint_path, scene_evidence
from ..keyframes.found_properties import known_matches
from ..shell import need
from ..shell.base_operator import BaseOperator, operator, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, Switch, Text
from ..shell.takes import active_take, add_take, footage_of


@operator("Add Performer", need.footage, need.idle)
def add_performer(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Add a take for another performer in the active take's clip, with an actor and markers of their own"""
    scene = context.scene
    source = active_take(scene)
    clip, camera, guessed = source.clip, source.camera, source.guessed_lens_mm
    placement = tuple(source.guessed_placement)
    files = [keypoint_path(entry) for entry in source.follow.files]
    stem = source.name.partition(" Performer ")[0]
    number = sum(take.clip == clip for take in scene.keymark.takes) + 1
    take = add_take(scene, f"{stem} Performer {number}")  # may move `source` in memory
    take.guessed_lens_mm, take.guessed_placement = guessed, placement
    take.camera, take.clip = camera, clip
    for path in files:
        add_keypoint_file(take, path)


take = need.of_take(lambda state: True, "There is no take to remove")


class KEYMARK_OT_remove_take(BaseOperator, bpy.types.Operator):
    """Remove the active take from the list; its clip, camera, actor and Actions stay, unless deleted too"""

    bl_label = "Remove Take"
    requirements = (take, need.idle)

    delete_data: Switch(
        "Delete Its Data",
        "Delete its actor, camera, clip and Actions too, its characters' included, except what "
        "another take uses; the characters stay",
        options=SKIP_SAVE,
    )

    def run(self, context: Context) -> None:
        settings = context.scene.keymark
        active = active_take(context.scene)
        index = next(i for i, each in enumerate(settings.takes) if each == active)
        own = set(_all_data_of(active))
        settings.takes.remove(index)
        settings.active_take = max(0, index - 1)
        if self.delete_data:
            kept_takes = [other for scene in bpy.data.scenes for other in scene.keymark.takes]
            deleted = own.difference(*(_all_data_of(other) for other in kept_takes))
            inner = [block.data for block in deleted if isinstance(block, bpy.types.Object)]
            alone = [block for block in inner if block is not None and block.users == 1]
            bpy.data.batch_remove([*deleted, *alone])


def _all_data_of(take: PropertyGroup) -> Iterator[ID]:
    yield from _data_of(take)
    for character in take.characters:
        yield from (result.action for result in character.results if result.action is not None)


def _data_of(group: PropertyGroup) -> Iterator[ID]:
    for definition in group.bl_rna.properties:
        if definition.type != "POINTER" or definition.identifier == "rna_type":
            continue
        value = getattr(group, definition.identifier)
        if isinstance(value, bpy.types.PropertyGroup):
            yield from _data_of(value)
        elif isinstance(value, bpy.types.ID):
            yield value


class KEYMARK_OT_save_take(BaseOperator, bpy.types.Operator):
    """Save footage, camera, actor, keyframes and what is followed as a take folder, to convert elsewhere"""

    bl_label = "Save Take"
    bl_options = {"REGISTER"}
    requirements = (need.footage, need.actor, need.idle)

    directory: Text("Folder", "Where take.json, keyframes.json and the clip are written", subtype="DIR_PATH")
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: Context) -> None:
        from ...core.shoot.discovery import check_hides_no_take
        from ...core.take.take import evidence_of
        from ...core.take.take_file import write_take
        from ..bridge.take_from_scene import read_scene_take

        if not self.directory:
            raise InputError("directory is empty; name the folder to save the take in")
        scene_take = active_take(context.scene)
        take, notes = run(
            read_scene_take(
                footage_of(context.scene, scene_take),
                scene_take.armature,
                scene_take.keyframe_action,
                scene_evidence(scene_take),
                known_matches(scene_take),
            )
        )
        folder = Path(bpy.path.abspath(self.directory))
        check_hides_no_take(folder)
        folder.mkdir(parents=True, exist_ok=True)
        has = evidence_of(take)
        # A camera that stands still brings contours, unless the take says that they are not followed.
        more = {} if scene_take.follow.use_hands else {"hands": False}
        write_take(take, folder, has if has and not take.contours else None, more)
        for note in notes:
            warn(self, note)
        self.report({"INFO"}, f"Saved the take in {folder}")
