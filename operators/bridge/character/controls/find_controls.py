"""Find the controls of a rig that no preset knows: free bones that others follow when they are posed."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import bpy

from .....core.body.skeleton import SIDES
from .....core.retarget.controls.control_plan import joint_roles
from .....core.retarget.controls.rigid_following import followed_controls
from .....core.retarget.maps.character_map import CharacterMap, IkControls, Switch
from .....core.retarget.roles import LIMBS
from .....core.text import Sentence
from .carrying_control import carrying_control
from .dependencies import (
    CARRYING,
    Graph,
    active_constraints,
    constrained_bones,
    constraint_bones,
    dependencies,
    driven_bone,
    drivers,
    upstream,
)
from .ik_targets import IkTargets, ik_targets, moving_bones
from .posing import posing, set_properties
from .random_poses import RandomPoses, pose_at_random
from .rig_switches import rig_switches

SAMPLES = 4
TURN_RAD = 0.2
"""Standard deviation of random turns about each axis."""
FEWEST_CONTROLS = 3
"""Fewer bones with shapes are not a rig's controls."""
MOST_CONTROLS = 400
"""Bones that are posed at most."""
SHARES = (".influence", ".weight", ".mute")
"""Properties of constraints, and of their targets, that a switch drives."""


@dataclass(frozen=True, eq=False)
class FoundControls:
    """A completed map."""

    character_map: CharacterMap
    notes: tuple[str, ...]


def find_controls(
    armature_object: bpy.types.Object, character_map: CharacterMap, size: float
) -> FoundControls:
    """Complete a map where constraints or drivers move bones with roles that it gives no controls for.

    Args:
        armature_object: A character that `require_character` accepts.
        character_map: Its map; what it says stays.
        size: The character's, in the armature's units.
    """
    graph = dependencies(armature_object)
    held = _held_bones(armature_object)
    own = {bone for role in character_map.roles for bone in character_map.bones(role)}
    moved = _moved_roles(character_map, held)
    if not moved:
        return FoundControls(character_map, ())
    bones = [bone for role in moved for bone in character_map.bones(role)]
    switches = {limb: _limb_switches(armature_object, graph, character_map, limb, moved) for limb in LIMBS}
    targets = {
        limb: target
        for limb in LIMBS
        if set(joint_roles(limb)) <= set(character_map.roles)
        and (target := ik_targets(armature_object, graph, character_map, limb)) is not None
    }
    looked_at = [name for each in targets.values() for name in (each.goal, each.pole) if name is not None]
    candidates = _candidates(armature_object, graph, own, [*bones, *looked_at])
    tried = _try_switches(armature_object, candidates, [*bones, *looked_at], switches, size)
    for name in looked_at:  # what several controls move together follows none of them while all are posed
        if all(followed.get(name) is None for _, _, followed in tried.followed):
            control = carrying_control(armature_object, graph, candidates, [name], size)
            for _, _, followed in tried.followed:
                followed[name] = control
    found = _completed(character_map, moved, tried, targets, _sharing(armature_object, graph, tried, bones))
    if "hips" in character_map.fk or "hips" in character_map.left_alone:
        return found
    return _with_hips(armature_object, graph, found, size)


def _with_hips(
    armature_object: bpy.types.Object, graph: Graph, found: FoundControls, size: float
) -> FoundControls:
    """The map with a control of the hips that carries the controls of the legs, where its own does not."""
    character_map = found.character_map
    hips = str(character_map.bone("hips"))
    on_hips = ("spine", *(f"thigh.{side}" for side in SIDES))
    carried = [hips]
    for role in on_hips:
        named = [name for name in character_map.keyed_bones(role) if name is not None]
        carried += list(dict.fromkeys([*named[:1], *named[-1:]]))
    candidates = _candidates(armature_object, graph, set(), carried)
    control = carrying_control(armature_object, graph, candidates, carried, size)
    if control is None or control in (hips, *character_map.keyed_bones("hips")):
        return found
    fk = dict(character_map.fk) | {"hips": (control,) + (None,) * (len(character_map.bones("hips")) - 1)}
    return replace(found, character_map=replace(character_map, fk=fk))


def _held_bones(armature_object: bpy.types.Object, carried: bool = True) -> set[str]:
    """Bones that others pose: by constraints with a bone to follow, chains of IK, or drivers.

    Args:
        armature_object: The character.
        carried: Whether those count that are only carried, as by a parent, and move no mesh.
    """
    held = {
        moved.name
        for bone in armature_object.pose.bones
        for constraint in active_constraints(bone)
        if any(True for _ in constraint_bones(armature_object, constraint))
        and (carried or constraint.type not in CARRYING or bone.bone.use_deform)
        for moved in constrained_bones(bone, constraint)
    }
    driven = {
        driven_bone(driver.data_path) for driver in drivers(armature_object) if _moves(driver.data_path)
    }
    return held | {name for name in driven if name is not None}


def _moves(path: str) -> bool:
    """Whether a data path is that of a bone's own channel."""
    return path.endswith(("location", "rotation_quaternion", "rotation_euler", "rotation_axis_angle"))


def _moved_roles(character_map: CharacterMap, held: set[str]) -> list[str]:
    """Roles that the map gives no controls for and whose bones something else moves."""
    return [
        role
        for role in character_map.roles
        if role not in character_map.fk
        and role not in character_map.left_alone
        and held & set(character_map.bones(role))
    ]


def _candidates(
    armature_object: bpy.types.Object, graph: Graph, playing: set[str], bones: Sequence[str]
) -> list[str]:
    """Bones that a person would pose and that some bones depend on, but for those that play a role.

    Where a rig has controls with shapes of their own, those; else the bones that are shown; else all.
    """
    own, held = armature_object.pose.bones, _held_bones(armature_object, carried=False) | playing
    free = sorted(name for name in upstream(graph, bones) if name in own and name not in held)
    shaped = [name for name in free if own[name].custom_shape is not None]
    shown = [name for name in free if _is_shown(own[name].bone)]
    for chosen in (shaped, shown):
        if len(chosen) >= FEWEST_CONTROLS:
            return chosen[:MOST_CONTROLS]
    return free[:MOST_CONTROLS]


def _is_shown(bone: bpy.types.Bone) -> bool:
    collections = bone.collections
    return not bone.hide and (not collections or any(one.is_visible_effectively for one in collections))


def _limb_switches(
    armature_object: bpy.types.Object,
    graph: Graph,
    character_map: CharacterMap,
    limb: str,
    moved: Sequence[str],
) -> list[Switch]:
    """Custom properties that may choose between IK and FK of a limb: they drive constraints that move it."""
    bones = [bone for role in LIMBS[limb] if role in moved for bone in character_map.bones(role)]
    moving = moving_bones(graph, character_map, limb, bones)
    paths = [
        driver.data_path
        for driver in drivers(armature_object)
        if driven_bone(driver.data_path) in moving and driver.data_path.endswith(SHARES)
    ]
    return rig_switches(armature_object, graph, paths)


@dataclass(frozen=True, eq=False)
class _Tried:
    """What bones follow while the switches stand at either end."""

    followed: tuple[tuple[int, bool, dict[str, str | None]], ...]
    """For each trial which of a limb's switches was moved, whether to its upper end, and by bone the control
    that it followed."""
    switches: Mapping[str, list[Switch]]

    def in_fk(self, limb: str, bones: Sequence[str]) -> tuple[Mapping[str, str | None], Switch | None]:
        """What the bones of a limb follow in FK, and the switch to it.

        FK is where most of the bones follow a control; where all switches lead to the same, there is none.
        """
        switches = self.switches[limb]
        counts = {(number, upper): _count(followed, bones) for number, upper, followed in self.followed}

        def sureness(trial: tuple[int, bool, dict[str, str | None]]) -> tuple[int, int]:
            number, upper, _ = trial
            count = counts[number, upper]
            return count, count - counts.get((number, not upper), count) if number < len(switches) else 0

        best = max(self.followed, key=sureness)
        number, upper, followed = best
        if not sureness(best)[1]:
            return followed, None
        switch = switches[number]  # holds its lower end as `ik`
        return followed, switch if upper else replace(switch, ik=switch.fk, fk=switch.ik)

    def in_ik(self, limb: str, switch: Switch | None) -> Mapping[str, str | None]:
        """What bones follow while a limb shows IK."""
        if switch is None:
            return self.followed[0][2]
        number = next(
            index
            for index, other in enumerate(self.switches[limb])
            if (other.bone, other.property) == (switch.bone, switch.property)
        )
        upper = switch.ik > switch.fk
        return next(trial[2] for trial in self.followed if trial[0] == number and trial[1] == upper)


def _count(followed: Mapping[str, str | None], bones: Sequence[str]) -> int:
    return sum(followed.get(bone) is not None for bone in bones)


def _try_switches(
    armature_object: bpy.types.Object,
    candidates: Sequence[str],
    observed: Sequence[str],
    switches: Mapping[str, list[Switch]],
    size: float,
) -> _Tried:
    """Pose the candidates at random with the switches at either end."""
    every = {(one.bone, one.property): None for found in switches.values() for one in found}
    trials = []
    bones = armature_object.pose.bones
    above = {name: parent.name for name in observed if (parent := bones[name].parent) is not None}
    looked_at = list(dict.fromkeys([*observed, *above.values()]))
    with posing(armature_object, list(every)):
        for number in range(max([1, *(len(found) for found in switches.values())])):
            moved = [found[number] for found in switches.values() if number < len(found)]
            for upper in (False, True) if moved else (False,):
                ends = {(one.bone, one.property): one.fk if upper else one.ik for one in moved}
                set_properties(armature_object, ends)
                poses = RandomPoses(SAMPLES, 0, TURN_RAD, 0.0)
                _, controls, shown = pose_at_random(armature_object, candidates, looked_at, poses)
                followed = dict(
                    zip(looked_at, followed_controls(candidates, controls, shown, size), strict=True)
                )
                trials.append((number, upper, {name: _own(followed, name, above) for name in observed}))
    return _Tried(tuple(trials), switches)


def _own(followed: Mapping[str, str | None], name: str, above: Mapping[str, str]) -> str | None:
    """The control that a bone follows, but for one that carries its parent as well."""
    control = followed[name]
    parent = above.get(name)
    return None if parent not in (None, control) and followed[parent] == control else control


def _sharing(
    armature_object: bpy.types.Object, graph: Graph, tried: _Tried, bones: Sequence[str]
) -> set[str]:
    """Bones that constraints turn by a share of what another bone's control does, as spines by a chest's."""
    found = set()
    for bone in bones:
        pose_bone = armature_object.pose.bones[bone]
        looked_at = {
            name
            for constraint in active_constraints(pose_bone)
            for name in constraint_bones(armature_object, constraint)
        }
        for _, _, followed in tried.followed:
            if followed.get(bone) is None and looked_at & {followed.get(other) for other in bones}:
                found.add(bone)
    return found


def _completed(
    character_map: CharacterMap,
    moved: Sequence[str],
    tried: _Tried,
    targets: Mapping[str, IkTargets],
    sharing: set[str],
) -> FoundControls:
    """The map with the controls that were found, and sentences on those that were not.

    Args:
        character_map: The map to complete.
        moved: Roles whose bones something moves.
        tried: What bones follow.
        targets: What limbs in inverse kinematics look at.
        sharing: Bones that are left to the controls of others.
    """
    fk = dict(character_map.fk)
    ik = dict(character_map.ik)
    lost: list[str] = []
    limb_of = {role: limb for limb, roles in LIMBS.items() for role in joint_roles(limb) if role in roles}
    for limb in LIMBS:
        roles = [role for role in LIMBS[limb] if role in moved]
        if not roles:
            continue
        followed, switch = tried.in_fk(limb, [bone for role in roles for bone in character_map.bones(role)])
        controls = _ik_controls(character_map, limb, tried, targets, followed, switch)
        if limb not in ik and controls is not None:
            ik[limb] = controls
        for role in roles:
            bones = character_map.bones(role)
            left = bones if limb in ik and role in limb_of else sharing
            fk[role] = _keyed(bones, followed, left)
            lost += [bone for bone in bones if followed.get(bone) is None and bone not in left]
    for role in moved:
        if role not in fk:
            bones, followed = character_map.bones(role), tried.followed[0][2]
            fk[role] = _keyed(bones, followed, sharing)
            lost += [bone for bone in bones if followed.get(bone) is None and bone not in sharing]
    names = ", ".join(f"'{bone}'" for bone in lost)
    notes = (
        (
            Sentence(
                "No control was found for what constraints or drivers move: {bones}; name the controls in "
                "the character map, or leave these roles alone",
                bones=names,
            ),
        )
        if lost
        else ()
    )
    return FoundControls(replace(character_map, fk=fk, ik=ik), notes)


def _keyed(
    bones: Sequence[str], followed: Mapping[str, str | None], left: Collection[str]
) -> tuple[str | None, ...]:
    """What is keyed for each of a role's bones: its control, or else itself if it is not left to others."""
    return tuple(followed.get(bone) or (None if bone in left else bone) for bone in bones)


def _ik_controls(
    character_map: CharacterMap,
    limb: str,
    tried: _Tried,
    targets: Mapping[str, IkTargets],
    followed: Mapping[str, str | None],
    switch: Switch | None,
) -> IkControls | None:
    """The controls of a limb's inverse kinematics; None where it has none."""
    target = targets.get(limb)
    if target is None:
        return None
    shown = tried.in_ik(limb, switch)
    goal = shown.get(target.goal)
    if goal is None:
        return None
    pole = None if target.pole is None else shown.get(target.pole)
    toe = None
    if limb.startswith("leg") and LIMBS[limb][-1] in character_map.roles:
        bone = str(character_map.bone(LIMBS[limb][-1]))
        toe = shown.get(bone) if shown.get(bone) != followed.get(bone) else None
    return IkControls(goal, pole, toe, switch)
