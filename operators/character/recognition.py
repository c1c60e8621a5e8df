"""Giving a bone to a role, as operators and their tooltips share it."""

from contextlib import suppress
from pathlib import Path

import bpy
from bpy.types import Context, Event, Operator, OperatorProperties, PropertyGroup

from ...core.errors import InputError, KeymarkError
from ...core.retarget.character import ROLES
from ...core.retarget.maps.character_map import write_character_map
from ..bridge.character.read_character import read_character
from ..library import registry
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, capitalized, chosen_file, operator, reported, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, File, Integer, Switch, Text
from . import characters
from .map_properties import clear_map, map_of, role_named, show_map


class RoleBoneOperator:
    """Mixin of an operator that gives a role a bone."""

    role: Text("Role", "The role, as in upper_arm.L", options=SKIP_SAVE)
    index: Integer("Index", "Number of the bone in a chain, from 0", min=0, options=SKIP_SAVE)


def give_bone(character: PropertyGroup, role: str, index: int, bone: str) -> None:
    """Give a role a bone, which makes it the person's.

    Raises:
        InputError: No such role, place or bone.
    """
    if role not in ROLES:
        raise InputError(f"there is no role '{role}'; roles are {', '.join(ROLES)}")
    if bone not in character.armature.data.bones:
        raise InputError(
            f"'{character.armature.name}' has no bone '{bone}'; give the name of one of its bones"
        )
    shown = role_named(character.character_map, role)
    if index >= len(shown.bones):
        raise InputError(
            f"the role {role} has {len(shown.bones)} bones, so there is no number {index}; add a bone first"
        )
    shown.bones[index].bone = bone


def active_bone_of(character: PropertyGroup) -> str | None:
    """Name of the active bone of a character's armature; None where there is none."""
    active = character.armature.data.bones.active if character.armature is not None else None
    return active.name if active is not None else None


def role_words(context: Context, role: str) -> str:
    """Where a role's bones come from and why they are doubtful, for a tooltip; empty where unknown."""
    character = characters.find_character(context.scene)
    if character is None or role not in character.character_map.roles:
        return ""
    shown = character.character_map.roles[role]
    if shown.doubt:
        return shown.doubt[:1].upper() + shown.doubt[1:]
    found = f"found by {shown.source}, {100.0 * shown.confidence:.0f} % sure"
    if shown.source == "you":
        found = "chosen by you"
    if not any(entry.bone for entry in shown.bones):
        found = "no bone"
    return f"{characters.full_title(role).capitalize()}: {found}"


def recognize_bones(character: PropertyGroup) -> None:
    """Recognize a character's bones and show them.

    Raises:
        InputError: It is none; properties stay.
    """
    from ...core.retarget.recognition.recognize import recognize

    characters.require_character_armature(character.armature)
    found = recognize(read_character(character.armature))
    # A doubt about a role alone begins with its name.
    words = {sentence: sentence.partition(" ")[0] for sentence in found.doubts}
    by_role = {role: capitalized(sentence) for sentence, role in words.items() if role in ROLES}
    show_map(character.character_map, found.character_map, by_role)
    show_doubts(character, tuple(sentence for sentence, role in words.items() if role not in ROLES))
    character.problem = ""


def show_doubts(character: PropertyGroup, doubts: tuple[str, ...] = ()) -> None:
    """Show what is doubtful about a character's map as a whole."""
    character.doubts.clear()
    characters.add_lines(character.doubts, doubts, "ERROR")


def say_recognized(operator: BaseOperator, character: PropertyGroup) -> None:
    """Report what came of recognizing a character's bones: what is wrong, or all that is doubtful."""
    doubts = [line.text for line in character.doubts]
    doubts += [role.doubt for role in character.character_map.roles if role.doubt]
    for sentence in [character.problem] if character.problem else doubts:
        warn(operator, sentence)
    if not character.problem and not doubts:
        operator.report({"INFO"}, f"Recognized the bones of '{character.armature.name}'")


def armature_chosen(character: PropertyGroup) -> None:
    """Find the armature's map elsewhere, or recognize it; what is wrong, the panel shows."""
    clear_map(character.character_map)
    show_doubts(character)
    character.problem = character.suggested = ""
    if character.armature is None:
        return
    for index in reversed(range(len(character.results))):  # those of another armature; their Actions stay
        if character.results[index].armature != character.armature:
            character.results.remove(index)
    character.active_result = max(0, len(character.results) - 1)
    known = characters.with_map(character.armature, beside=character)
    if known is not None:
        show_map(character.character_map, map_of(known.character_map))
        return
    with suppress(ModuleNotFoundError):  # operators report it
        from ...core.retarget.maps.map_registry import map_for
        from ..bridge.character.read_character import read_character

        try:
            recognize_bones(character)
            found = map_for(read_character(character.armature), map_folders())
            character.suggested = "" if found is None else found.title
        except KeymarkError as error:
            character.problem = capitalized(str(error))


def map_folders() -> list[Path]:
    """Folders in which character maps are looked for: that of the user's keyframe libraries."""
    return [registry.own_folder()]


@operator("Recognize", characters.armature, need.idle)
def recognize_character(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Find out which bones play which role, by their names and places; replaces what you chose before"""
    character = characters.active_character(context.scene)
    recognize_bones(character)
    say_recognized(operator, character)


class KEYMARK_OT_load_map(BaseOperator, bpy.types.Operator):
    """Load which bones play which role from a file, instead of what was recognized"""

    bl_label = "Load Map"
    requirements = (characters.armature, need.idle)

    filepath: File("A character map")
    title: Text("Title", "Title of a map in your library folder, instead of a file", options=SKIP_SAVE)
    filter_glob: Text(default="*.json", options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        if properties.title:
            return "Use this map from your library folder, which names this armature's bones"
        return "Load which bones play which role from a file, instead of what was recognized"

    def invoke(self, context: Context, event: Event) -> set[str]:
        if self.filepath or self.title:
            return self.execute(context)
        return browse(self, context, str(map_folders()[0]))

    def run(self, context: Context) -> None:
        from ...core.retarget.maps.map_registry import check_map, find_map

        character = characters.active_character(context.scene)
        by_title = self.title and not self.filepath
        named = self.title if by_title else chosen_file(self, "a character map, .json")
        found = find_map(named, map_folders())
        check_map(found.valid, read_character(character.armature), str(found.path))
        show_map(character.character_map, found.valid)
        show_doubts(character)
        character.problem = character.suggested = ""
        self.report({"INFO"}, f"Loaded '{found.valid.title}'")


class KEYMARK_OT_save_map(BaseOperator, bpy.types.Operator):
    """Save which bones play which role as a file; in the folder that is offered it is found again"""

    bl_label = "Save Map"
    bl_options = {"REGISTER"}
    requirements = (characters.armature, characters.recognized, need.idle)

    filepath: Text("File", "File to write", subtype="FILE_PATH")
    check_existing: Switch(default=True, options=HIDDEN)
    filter_glob: Text(default="*.json", options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        from ...core.retarget.maps.map_registry import map_path

        with reported(self):
            title = _title(characters.active_character(context.scene))
            self.filepath = str(map_path(map_folders()[0], title))
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def check(self, context: Context) -> bool:
        path = bpy.path.ensure_ext(self.filepath, ".json")
        changed = path != self.filepath
        self.filepath = path
        return changed

    def draw(self, context: Context) -> None:
        character, column = characters.active_character(context.scene), self.layout.column()
        if character is not None:
            for name in ("title", "author", "license", "description", "tags"):
                column.prop(character.character_map, name)

    def run(self, context: Context) -> None:
        if not self.filepath:
            raise InputError("no file is named to save the map to; give filepath")
        character = characters.active_character(context.scene)
        character.character_map.title = _title(character)
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), ".json"))
        write_character_map(path, map_of(character.character_map))
        self.report({"INFO"}, f"Wrote {path}")


def _title(character: PropertyGroup) -> str:
    return character.character_map.title.strip() or str(character.armature.name)
