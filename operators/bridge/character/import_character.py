"""Import a character from a file: its armature, the meshes that this moves, and all that both need."""

import shutil
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import bpy
from bpy.types import Object, Scene, Text

from ....core.errors import InputError, shown
from ....core.files.fields import listed
from ....core.files.paths import real_path, regular_file_size
from ....core.take.conversion_settings import CharacterFile
from ..blend_files import check_blend, one_line, showing_scene
from .held_controls import constraint_targets

MOST_NAMED = 5  # armatures named in a sentence
BLEND, VRM = ".blend", ".vrm"
NOT_ALONG = (
    "ARMATURE",
    "CAMERA",
    "LIGHT",
    "SPEAKER",
    "LIGHT_PROBE",
)  # that look at it, and no members


@dataclass(frozen=True, eq=False)
class ImportedCharacter:
    """A character in a scene."""

    file: CharacterFile
    armature: Object
    objects: tuple[Object, ...]  # all that is in the scene, the armature among them
    texts: tuple[Text, ...] = ()  # scripts that Blender registers when a person opens the file; not run here
    notes: tuple[str, ...] = ()  # what a person should know, in sentences without a full stop


def import_character(
    file: CharacterFile, scene: Scene, animated: bool = False, text: str | None = None
) -> ImportedCharacter:
    """Import a character into a scene of its own (see `own_scene`), which removes it again.

    Of a .blend objects are appended; nothing in it is run. Other files are read by Blender's own importers,
    without their motions unless `animated`; a `text` is read in the file's place. The objects get a
    collection with the armature's name. InputError where Blender cannot read the file, it has no such
    armature or none at all, or several and none is named.
    """
    regular_file_size(file.path, "a character file")
    suffix = file.path.suffix.lower()
    if suffix == BLEND:
        found, texts = _appended(file, animated)
    else:
        found, texts = _imported(file, scene, animated, text), ()
    armature = _chosen(file, found)
    members = _members(armature, found.values())
    notes: tuple[str, ...] = ()
    if suffix == BLEND and not animated:
        tracks = armature.animation_data.nla_tracks if armature.animation_data is not None else ()
        playing = [track for track in tracks if not track.mute]
        for track in playing:
            track.mute = True
        names = listed((shown(track.name) for track in playing), MOST_NAMED)
        notes = (f"NLA tracks of '{armature.name}' are muted in the copy: {names}",) if playing else ()
    elif not animated:
        for one in members:
            one.animation_data_clear()
            keys = getattr(one.data, "shape_keys", None)
            if keys is not None:
                keys.animation_data_clear()
        for bone in armature.pose.bones:
            bone.matrix_basis.identity()
    for other in list(scene.collection.children):
        scene.collection.children.unlink(other)
    for one in list(scene.collection.objects):
        scene.collection.objects.unlink(one)
    collection = bpy.data.collections.new(armature.name)
    scene.collection.children.link(collection)
    for one in members:
        collection.objects.link(one)
    armature.hide_viewport = False  # else Blender would not evaluate it
    scene.view_layers[0].update()
    return ImportedCharacter(file, armature, tuple(members), texts, notes)


def _appended(file: CharacterFile, animated: bool) -> tuple[dict[str, Object], tuple[Text, ...]]:
    check_blend(file.path, "a character")
    if bpy.data.filepath and Path(bpy.data.filepath).resolve() == file.path.resolve():
        why = "is open in this Blender, which appends nothing from it"
        raise InputError(f"{file.path}: {why}; name a copy of it, or run the command without opening it")
    try:
        with bpy.data.libraries.load(str(real_path(file.path)), link=False) as (inside, wanted):
            names = list(inside.objects)
            wanted.objects = list(names)
            wanted.texts = list(inside.texts)
            wanted.actions = list(inside.actions) if animated else []
    except (OSError, RuntimeError, UnicodeDecodeError) as error:
        raise _unreadable(file.path, error) from error
    objects = {name: one for name, one in zip(names, wanted.objects, strict=True) if one is not None}
    return objects, tuple(text for text in wanted.texts if text is not None and text.use_module)


def _imported(file: CharacterFile, scene: Scene, animated: bool, text: str | None) -> dict[str, Object]:
    before = {one.name for one in bpy.data.objects}
    with showing_scene(scene), tempfile.TemporaryDirectory() as folder:
        path = real_path(file.path)
        if path.suffix.lower() == VRM:  # a GLB under another name
            path = Path(shutil.copyfile(path, Path(folder) / f"{path.stem}.glb"))
        if text is not None:
            path = Path(folder) / path.name
            path.write_text(text, encoding="utf-8")
        start = path.suffix.lower()[:4]
        importer = IMPORTERS.get(start, IMPORTERS[".g"])
        try:
            importer(animated)(filepath=str(path))
        except (RuntimeError, AttributeError, OSError, ValueError, ArithmeticError, LookupError) as error:
            raise _unreadable(file.path, error) from error
    found = {}
    for one in scene.objects:  # without the number that a name got because it was taken
        stem, _, number = one.name.rpartition(".")
        found[stem if number.isdigit() and stem in before else one.name] = one
    return found


IMPORTERS: dict[str, Callable[[bool], Callable[..., object]]] = {
    ".fbx": lambda animated: partial(bpy.ops.wm.fbx_import, use_anim=animated),
    ".bvh": lambda _: partial(bpy.ops.import_anim.bvh, update_scene_fps=True, rotate_mode="NATIVE"),
    ".usd": lambda _: bpy.ops.wm.usd_import,
    ".g": lambda _: partial(bpy.ops.import_scene.gltf, disable_bone_shape=True),
}
"""Blender's own importers by the beginning of endings; bones of glTF would be balls that fill the view."""


def _unreadable(path: Path, error: Exception) -> InputError:
    lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith("Location:")]
    reason = one_line(RuntimeError(lines[-1] if lines else str(error))).removeprefix("Error: ")
    return InputError(
        f"{path}: Blender cannot read it as a character ({reason}); it may be damaged or cut off"
    )


def _chosen(file: CharacterFile, found: dict[str, Object]) -> Object:
    armatures = {name: one for name, one in found.items() if one.type == "ARMATURE"}
    names = listed(map(shown, sorted(armatures)), MOST_NAMED)
    if not armatures:
        raise InputError(
            f"{file.path}: holds no armature; a character is an armature with the meshes that it moves, "
            "and one that is linked from another file is named by that file"
        )
    if file.object is not None:
        if file.object not in armatures:
            wrong = "is no armature" if file.object in found else "is not in it"
            raise InputError(f"{file.path}: {shown(file.object)} {wrong}; its armatures are {names}")
        return armatures[file.object]
    if len(armatures) > 1:
        example = CharacterFile(file.path, min(armatures))
        raise InputError(f"{file.path}: holds {len(armatures)} armatures, {names}; name one, as in {example}")
    return next(iter(armatures.values()))


def _members(armature: Object, found: Iterable[Object]) -> list[Object]:
    """The armature, what hangs on it or is deformed by it, and the objects that these need."""
    objects = list(found)
    members = {armature, *armature.children_recursive}
    for one in objects:
        targets = [getattr(modifier, "object", None) for modifier in one.modifiers]
        if one.type not in NOT_ALONG:
            targets += [getattr(constraint, "target", None) for constraint in one.constraints]
        if armature in targets:
            members.add(one)
    for one in list(members):
        members.update(one.children_recursive)
    users = bpy.data.user_map(subset=objects)
    shapes = {bone.custom_shape for one in members if one.type == "ARMATURE" for bone in one.pose.bones}
    growing = True
    while growing:
        needed = {one for one in objects if one not in members | shapes and users.get(one, set()) & members}
        growing = bool(needed)
        members |= needed
    return [one for one in objects if one in members]


CARRIERS = ("CHILD_OF", "COPY_TRANSFORMS", "ARMATURE")  # by which a bone carries an object as a parent does


def skins(armature_object: Object) -> list[Object]:
    """The rendered meshes that the armature deforms or carries, in its first scene."""
    return [
        one
        for scene in armature_object.users_scene[:1]
        for one in scene.objects
        if one.type == "MESH"
        and not one.hide_render
        and (is_deformed(one, armature_object) or carrying_bone(one, armature_object) is not None)
    ]


def carrying_bone(one: Object, armature_object: Object) -> str | None:
    """The bone that carries an object, empty for the armature object itself; None where neither does."""
    at: Object | None = one
    while at is not None and at != armature_object:
        for constraint in at.constraints:
            if constraint.type in CARRIERS and not constraint.mute and constraint.influence > 0.0:
                for target, bone in constraint_targets(constraint):
                    if target == armature_object and bone:
                        return bone
        if at.parent == armature_object and at.parent_type == "BONE":
            return str(at.parent_bone)
        at = at.parent
    return None if at is None else ""


def is_deformed(mesh_object: Object, armature_object: Object) -> bool:
    """Whether an armature deforms a mesh."""
    deforming = [one.object for one in mesh_object.modifiers if one.type == "ARMATURE"]
    by_parent = mesh_object.parent_type == "ARMATURE" and mesh_object.parent == armature_object
    return by_parent or armature_object in deforming
