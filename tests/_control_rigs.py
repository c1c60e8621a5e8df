"""Control rigs that no preset knows, on a plain skeleton: FK and IK chains, switches, a body control."""

import bpy
import numpy as np
from _armatures import build_character
from _characters import plain_character, plain_map
from keymark.core.retarget.character import Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap

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
