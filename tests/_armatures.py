"""Armatures in Blender, made from characters of `_characters`; control rigs, and Rigify's basic human."""

import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
from _boot import ROOT
from _characters import plain_character, plain_map
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.progress import run
from keymark.core.retarget.character import Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.take.conversion_settings import RetargetOptions
from keymark.operators.bridge.actions import curves_of
from keymark.operators.bridge.character.retarget import Retargeted, retarget
from keymark.operators.bridge.keys import keys_changed
from mathutils import Matrix


def build_character(character: Character, scene: bpy.types.Scene | None = None) -> bpy.types.Object:
    """An armature object with the character's bones and scale, active in the context's view layer."""
    armature = bpy.data.armatures.new(character.name)
    armature_object = bpy.data.objects.new(character.name, armature)
    (scene or bpy.context.scene).collection.objects.link(armature_object)
    bpy.context.view_layer.objects.active = armature_object
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in character.bones:
        edit_bone = armature.edit_bones.new(bone.name)
        edit_bone.tail = (0.0, float(np.linalg.norm(bone.tail - bone.head)), 0.0)
        edit_bone.matrix = Matrix(bone.rest)
        edit_bone.use_deform = bone.deforms
        if bone.parent >= 0:
            edit_bone.parent = armature.edit_bones[character.bones[bone.parent].name]
            edit_bone.use_connect = bone.connected
    bpy.ops.object.mode_set(mode="OBJECT")
    armature_object.scale = (character.scale,) * 3
    bpy.context.view_layer.update()
    return armature_object


# --- Control rigs that no preset knows, on a plain skeleton: FK and IK chains, switches, a body control


LIMBS = {"arm": ("upper_arm", "forearm", "hand"), "leg": ("thigh", "shin", "foot")}
FREE = ("spine", "chest", "neck", "head", "shoulder", "finger")
POLE_M = 0.4


def control_rig(pole_behind: bool = False) -> tuple[bpy.types.Object, CharacterMap]:
    """A character whose bones copy controls called `fk_...`, or reach for `ik_...`, by the property `to_ik`.

    Args:
        pole_behind: Whether poles lie on the other side of elbows and knees, with a pole angle to match.

    Returns:
        The armature object, and the map of its deform bones, which knows of no control.
    """
    plain = plain_character()
    bones = list(plain.bones)
    index = dict(plain.index)

    def add(name: str, like: str, parent: str | None, place: np.ndarray | None = None) -> None:
        bone = plain.bone(like)
        rest = bone.rest.copy()
        shift = np.zeros(3) if place is None else place - bone.head
        rest[:3, 3] += shift
        above = -1 if parent is None else index[parent]
        index[name] = len(bones)
        bones.append(CharacterBone(name, above, rest, bone.tail + shift, deforms=False))

    add("body", "hips", None)
    for kind, parts in LIMBS.items():
        for side in "LR":
            on = "body" if kind == "leg" else f"shoulder.{side}"
            for chain in ("fk", "mch"):
                above = on
                for part in parts if chain == "fk" else parts[:2]:
                    add(f"{chain}_{part}.{side}", f"{part}.{side}", above)
                    above = f"{chain}_{part}.{side}"
            add(f"ik_{parts[2]}.{side}", f"{parts[2]}.{side}", None)
            joint = plain.bone(f"{parts[1]}.{side}").head
            out = np.array([0.0, -POLE_M if kind == "leg" else POLE_M, 0.0])
            add(f"pole_{kind}.{side}", "head", None, joint + (-out if pole_behind else out))
    made = build_character(Character("Rig", tuple(bones)))
    shape = bpy.data.objects.new("Shape", None)
    own = made.pose.bones
    for name in index:
        if name.startswith(("body", "fk_", "ik_", "pole_")) or name.partition(".")[0] in FREE:
            own[name].custom_shape = shape
    _copy(made, "hips", "body")
    for kind, parts in LIMBS.items():
        for side in "LR":
            _limb(made, kind, parts, side, pole_behind)
    bpy.context.view_layer.update()
    return made, plain_map(plain)


def _limb(made: bpy.types.Object, kind: str, parts: tuple[str, ...], side: str, behind: bool) -> None:
    holder = made.pose.bones[f"ik_{parts[2]}.{side}"]
    holder["to_ik"] = 1.0
    constraint = made.pose.bones[f"mch_{parts[1]}.{side}"].constraints.new("IK")
    constraint.target, constraint.subtarget = made, holder.name
    constraint.pole_target, constraint.pole_subtarget = made, f"pole_{kind}.{side}"
    constraint.chain_count = 2
    constraint.use_stretch = False
    constraint.pole_angle = _pole_angle(made, parts, side, made.data.bones[f"pole_{kind}.{side}"].head_local)
    for part in parts:
        bone = f"{part}.{side}"
        _copy(made, bone, f"fk_{bone}")
        _copy(made, bone, f"mch_{bone}" if part != parts[2] else holder.name)
        curve = made.pose.bones[bone].constraints[-1].driver_add("influence")
        variable = curve.driver.variables.new()
        variable.targets[0].id = made
        variable.targets[0].data_path = f'pose.bones["{holder.name}"]["to_ik"]'
        curve.driver.expression = variable.name
    if parts[2] == "hand":  # the wrist hangs on the forearm's end
        made.pose.bones[f"{parts[2]}.{side}"].constraints[-1].subtarget = holder.name


def _pole_angle(made: bpy.types.Object, parts: tuple[str, ...], side: str, pole: object) -> float:
    """The pole angle with which the limb rests as it is built (the angle from the bone's X to the pole)."""
    bones = made.data.bones
    upper, lower = bones[f"{parts[0]}.{side}"], bones[f"{parts[1]}.{side}"]
    normal = (lower.tail_local - upper.head_local).cross(pole - upper.head_local)
    across = normal.cross(upper.tail_local - upper.head_local)
    x = upper.matrix_local.to_3x3().col[0]
    angle = x.angle(across)
    along = upper.tail_local - upper.head_local
    return -angle if x.cross(across).angle(along) < 1.0 else angle


def _copy(made: bpy.types.Object, bone: str, control: str) -> None:
    constraint = made.pose.bones[bone].constraints.new("COPY_TRANSFORMS")
    constraint.target, constraint.subtarget = made, control


# --- Rigify's basic human, generated by the Rigify that comes with Blender, for tests


SCRIPT = ROOT / "operators" / "cli" / "generate_rigify_human.py"
LIMIT_S = 300


def rigify_file(folder: Path) -> Path:
    """A .blend with the rig as object `Human`, made where the folder has none."""
    file = folder / f"rigify_human_{bpy.app.version[0]}_{bpy.app.version[1]}.blend"
    if not file.is_file():
        draft = file.with_suffix(".draft.blend")
        run_script(SCRIPT, draft)
        draft.replace(file)
    return file


def run_script(script: Path, file: Path) -> None:
    """Let a script that uses Rigify make a file, in a process of its own with this Blender."""
    blender = bpy.app.binary_path
    python = [blender, "-b", "--factory-startup", "--python"] if blender else [sys.executable]
    command = [*python, str(script), *(["--"] if blender else []), str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S)
    assert done.returncode == 0, done.stdout + done.stderr


def add_rig(file: Path, name: str = "Human", link: bool = False) -> bpy.types.Object:
    """Append an object of a .blend to the context's scene, or link it."""
    with bpy.data.libraries.load(str(file), link=link) as (_, wanted):
        wanted.objects = [name]
    (rig,) = wanted.objects
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.context.view_layer.update()
    return rig


def retargeted(
    character: bpy.types.Object,
    character_map: CharacterMap,
    source: SegmentMotion,
    options: RetargetOptions = RetargetOptions(),  # noqa: B008
) -> Retargeted:
    """A motion on a character, written and assigned from frame 11 on."""
    made = run(retarget(character, source, 11.0 + np.arange(len(source.time_s)), character_map, options))
    made.write(bpy.context.scene, "Steps")
    return made


def move_a_key(action: bpy.types.Action) -> None:
    """Move a key of an Action, as an animator does."""
    curve = next(curve for (path, _), curve in curves_of(action).items() if path.endswith("location"))
    curve.keyframe_points[0].co[1] += 0.1
    curve.update()
    keys_changed()
