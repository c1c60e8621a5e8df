"""What moves what inside an armature: parents, constraints and drivers as a graph.

Its nodes are bones by name and driven properties by data path.
"""

import re
from collections.abc import Iterable, Iterator

import bpy

BONE_PATH = re.compile(r'^pose\.bones\["((?:[^"\\]|\\.)*)"\]')
PROPERTY_PATH = re.compile(r'^pose\.bones\["((?:[^"\\]|\\.)*)"\]\["((?:[^"\\]|\\.)*)"\]$')
CONSTRAINT_PATH = re.compile(r'^pose\.bones\["(?:[^"\\]|\\.)*"\]\.constraints\["((?:[^"\\]|\\.)*)"\]')
CARRYING = ("CHILD_OF", "ARMATURE")
"""Constraints that carry a bone as a parent does: its own channels still count."""
VECTORS = ("location", "rotation_quaternion", "rotation_axis_angle", "rotation_euler", "scale")
"""Properties of several components, each with a driver of its own."""

Graph = dict[str, set[str]]
"""By bone, or data path of a property, all that it depends on."""


def dependencies(armature_object: bpy.types.Object) -> Graph:
    """What each bone and each driven property of an armature directly depends on."""
    graph: Graph = {bone.name: set() for bone in armature_object.pose.bones}
    for bone in armature_object.pose.bones:
        if bone.parent is not None:
            graph[bone.name].add(bone.parent.name)
        for constraint in active_constraints(bone):
            targets = {name for name in constraint_bones(armature_object, constraint) if name in graph}
            for moved in constrained_bones(bone, constraint):
                graph[moved.name] |= targets
    for driver in drivers(armature_object):
        seen = set(_read_by(armature_object, driver))
        bone, node = driven_bone(driver.data_path), driven_property(driver)
        graph.setdefault(node, set()).update(seen)
        if bone in graph and not _is_custom_property(driver.data_path):
            graph[bone].add(node)
    read = {one for nodes in graph.values() for one in nodes}
    graph |= {one: set() for one in read if one not in graph}
    return graph


def upstream(graph: Graph, names: Iterable[str]) -> set[str]:
    """All that these nodes depend on, directly or not, themselves included."""
    found: set[str] = set()
    waiting = list(names)
    while waiting:
        name = waiting.pop()
        if name in graph and name not in found:
            found.add(name)
            waiting += graph[name]
    return found


def active_constraints(bone: bpy.types.PoseBone) -> list[bpy.types.Constraint]:
    """The constraints of a bone that move it, or may do so once their influence is driven."""
    valid = [constraint for constraint in bone.constraints if constraint.is_valid]
    if all(constraint.influence > 0.0 and not constraint.mute for constraint in valid):
        return valid
    driven = _driven_constraints(bone)
    return [one for one in valid if (one.influence > 0.0 and not one.mute) or one.name in driven]


def constraint_bones(armature_object: bpy.types.Object, constraint: bpy.types.Constraint) -> Iterator[str]:
    """Names of the armature's own bones that a constraint looks at."""
    pairs = [
        (getattr(constraint, "target", None), getattr(constraint, "subtarget", "")),
        (getattr(constraint, "pole_target", None), getattr(constraint, "pole_subtarget", "")),
    ]
    if constraint.type == "ARMATURE":
        pairs += [(target.target, target.subtarget) for target in constraint.targets]
    for target, name in pairs:
        if target == armature_object and name:
            yield name


def constrained_bones(bone: bpy.types.PoseBone, constraint: bpy.types.Constraint) -> list[bpy.types.PoseBone]:
    """The bones that a constraint of a bone moves: with inverse kinematics a chain of parents."""
    if constraint.type not in ("IK", "SPLINE_IK"):
        return [bone]
    chain: list[bpy.types.PoseBone] = []
    above = bone if getattr(constraint, "use_tail", True) else bone.parent
    while above is not None and (constraint.chain_count == 0 or len(chain) < constraint.chain_count):
        chain.append(above)
        above = above.parent
    return chain


def drivers(armature_object: bpy.types.Object) -> list[bpy.types.FCurve]:
    """The drivers of an armature object that work."""
    data = armature_object.animation_data
    return [] if data is None else [curve for curve in data.drivers if not curve.mute]


def driven_property(driver: bpy.types.FCurve) -> str:
    """Data path of the property that a driver drives, with its index where it is one of several."""
    path = driver.data_path
    return f"{path}[{driver.array_index}]" if path.endswith(VECTORS) else path


def driven_bone(path: str) -> str | None:
    """The bone whose property a data path names."""
    found = BONE_PATH.match(path)
    return bpy.utils.unescape_identifier(found[1]) if found else None


def driven_constraint(path: str) -> str | None:
    """The constraint whose property a data path names."""
    found = CONSTRAINT_PATH.match(path)
    return bpy.utils.unescape_identifier(found[1]) if found else None


def custom_property(path: str) -> tuple[str, str] | None:
    """The bone and the custom property of it that a data path names."""
    found = PROPERTY_PATH.match(path)
    if found is None:
        return None
    return bpy.utils.unescape_identifier(found[1]), bpy.utils.unescape_identifier(found[2])


def _driven_constraints(bone: bpy.types.PoseBone) -> set[str]:
    """Names of the constraints of a bone with a driven or keyed property."""
    data = bone.id_data.animation_data
    if data is None:
        return set()
    paths = [curve.data_path for curve in data.drivers]
    return {
        name
        for path in paths
        if driven_bone(path) == bone.name and (name := driven_constraint(path)) is not None
    }


def _read_by(armature_object: bpy.types.Object, driver: bpy.types.FCurve) -> Iterator[str]:
    """Bones and data paths of the armature that a driver's variables read."""
    for variable in driver.driver.variables:
        for target in variable.targets:
            if target.id not in (armature_object, armature_object.data):
                continue
            if variable.type == "SINGLE_PROP":
                if target.id == armature_object:
                    yield from _read_path(target.data_path)
            elif target.bone_target:
                yield target.bone_target


def _read_path(path: str) -> Iterator[str]:
    """The property of a data path; where it shows a bone's pose the bone itself."""
    component = re.match(r"^(.*)\.([xyzw])$", path)
    if component and component[1].endswith(VECTORS):
        first = "wxyz" if component[1].endswith("rotation_quaternion") else "xyzw"
        path = f"{component[1]}[{first.index(component[2])}]"
    yield path
    bone = driven_bone(path)
    if bone is not None and re.search(r"\]\.(matrix|head|tail|center|vector)\b", path):
        yield bone


def _is_custom_property(path: str) -> bool:
    """Whether a path names a custom property of a bone, which moves nothing by itself."""
    return BONE_PATH.sub("", path).startswith("[")
