"""What moves bones beside their keys: constraints and drivers."""

import re
from collections.abc import Iterator

import bpy

BONE_PATH = re.compile(r'^pose\.bones\["((?:[^"\\]|\\.)*)"\]')
CONSTRAINT_PATH = re.compile(BONE_PATH.pattern + r'\.constraints\["((?:[^"\\]|\\.)*)"\]')


def active_constraints(bone: bpy.types.PoseBone) -> list[bpy.types.Constraint]:
    """The constraints of a bone that move it, or may do so once their influence is driven."""
    valid = [constraint for constraint in bone.constraints if constraint.is_valid]
    if all(constraint.influence > 0.0 and not constraint.mute for constraint in valid):
        return valid
    driven = {
        tuple(map(bpy.utils.unescape_identifier, found.groups()))
        for driver in drivers(bone.id_data)
        if (found := CONSTRAINT_PATH.match(driver.data_path))
    }
    return [one for one in valid if (one.influence > 0.0 and not one.mute) or (bone.name, one.name) in driven]


def constraint_bones(armature_object: bpy.types.Object, constraint: bpy.types.Constraint) -> Iterator[str]:
    """Names of the armature's own bones that a constraint looks at."""
    targets = constraint.targets if constraint.type == "ARMATURE" else [constraint]
    for target in targets:
        if getattr(target, "target", None) == armature_object and target.subtarget:
            yield target.subtarget


def drivers(armature_object: bpy.types.Object) -> list[bpy.types.FCurve]:
    """The drivers of an armature object that work."""
    data = armature_object.animation_data
    return [] if data is None else [curve for curve in data.drivers if not curve.mute]


def driven_bone(path: str) -> str | None:
    """The bone whose property a data path names."""
    found = BONE_PATH.match(path)
    return bpy.utils.unescape_identifier(found[1]) if found else None
