"""Switches of a rig: custom properties that drive how its constraints work."""

from collections.abc import Iterable

import bpy

from .....core.retarget.maps.character_map import Switch
from .dependencies import Graph, custom_property, upstream

FALLBACK = (0.0, 1.0)
"""Ends of a property that says nothing of its range."""


def rig_switches(armature_object: bpy.types.Object, graph: Graph, bones: Iterable[str]) -> list[Switch]:
    """The custom properties of pose bones on which the poses of some bones depend, from end to end.

    Which end shows IK is not known yet: `ik` holds the lower one.
    """
    found = []
    for node in sorted(upstream(graph, bones)):
        bone, name = custom_property(node) or (None, None)
        if bone is None or name is None or graph[node]:  # what is driven itself is no switch
            continue
        held = armature_object.pose.bones.get(bone)
        if held is not None and isinstance(held.get(name), int | float):
            found.append(Switch(bone, name, *_ends(held, name)))
    return found


def _ends(bone: bpy.types.PoseBone, name: str) -> tuple[float, float]:
    """The ends of a property's range; of a wide range only 0 and 1, which switches have."""
    if isinstance(bone[name], bool):
        return FALLBACK
    about = bone.id_properties_ui(name).as_dict()
    low, high = float(about.get("min", 0.0)), float(about.get("max", 1.0))
    return (low, high) if high - low <= FALLBACK[1] else FALLBACK
