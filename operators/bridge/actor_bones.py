"""Telling Keymark's actors from other armatures, by the names of their bones alone: quick enough to draw."""

import bpy

from ...core.body.human import HUMAN

ACTOR_BONES = frozenset(segment.name for segment in HUMAN.segments)


def is_actor(candidate: bpy.types.Object | None) -> bool:
    """Whether an object is an armature with all the bones of Keymark's skeleton."""
    if candidate is None or candidate.type != "ARMATURE" or candidate.data is None:
        return False
    return ACTOR_BONES <= set(candidate.data.bones.keys())
