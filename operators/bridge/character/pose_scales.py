"""Bones that a pose scales: a motion that is solved for the rest's lengths keys them at one."""

from collections.abc import Iterable

import bpy

ONE = (1.0, 1.0, 1.0)
NOTICEABLE = 1e-3


def scaled_bones(armature_object: bpy.types.Object, names: Iterable[str]) -> tuple[str, ...]:
    """The bones, and those above them, that are scaled now."""
    found: dict[str, None] = {}
    for name in names:
        bone = armature_object.pose.bones[name]
        for one in (bone, *bone.parent_recursive):
            if max(abs(value - 1.0) for value in one.scale) > NOTICEABLE:
                found[one.name] = None
    return tuple(found)
