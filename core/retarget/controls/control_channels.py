"""Controls: which bones are keyed and what for, in which spaces they act, and channels in these for poses."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from types import MappingProxyType

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...body.posture_fit import nearest_rotation
from ...take.conversion_settings import LimbKeys, RetargetOptions, RootMotion
from ..character import FINGER_ROLES, JOINTS, LIMBS, ROLES, Character
from ..maps.character_map import CharacterMap


class ControlKind(Enum):
    """What a control does."""

    FK = "fk"  # it turns a bone, and places it where it can and must
    HIPS = "hips"  # it turns and places the hips
    GOAL = "goal"  # hand or foot follow it by inverse kinematics
    FINGER = "finger"  # it bends a bone of a finger
    TOE = "toe"  # it turns the toes while the leg is in IK
    POLE = "pole"  # elbow or knee point to it
    ROOT = "root"  # it carries the whole character
    CARRIER = "carrier"  # it places hips that are connected to it, whose own location Blender ignores


IN_FK = (ControlKind.FK, ControlKind.HIPS, ControlKind.FINGER)


@dataclass(frozen=True)
class PlannedControl:
    """A bone that is to be keyed."""

    name: str
    kind: ControlKind
    bone: str  # the bone with a role that it moves; for a pole the one that begins at elbow or knee
    limb: str | None = None  # the limb of `LIMBS` whose inverse kinematics it belongs to, or is carried by


def planned_controls(
    character_map: CharacterMap, options: RetargetOptions, character: Character | None = None
) -> tuple[PlannedControl, ...]:
    """The controls that are keyed, each once; of a character also the one that carries connected hips."""
    wanted: list[tuple[str | None, ControlKind, str | None, str | None]] = []
    if options.root_motion is RootMotion.ROOT_BONE:
        wanted.append((character_map.root, ControlKind.ROOT, character_map.root, None))
    not_in_fk = set(character_map.left_alone)
    for limb, ik in character_map.ik.items():
        keys, last = limb_keys(character_map, options, limb), LIMBS[limb][-1]
        if keys is LimbKeys.FK:
            continue
        _, middle, end = limb_bones(character_map, limb)
        toe = None if last in character_map.left_alone else character_map.bone(last)
        wanted.append((ik.goal, ControlKind.GOAL, end, limb))
        wanted += [(ik.toe, ControlKind.TOE, toe, limb), (ik.pole, ControlKind.POLE, middle, limb)]
        if keys is LimbKeys.IK:  # not the shoulder; the toes where they have a control
            not_in_fk.update(JOINTS[limb] if ik.toe is None else (*JOINTS[limb], last))
    for role in ROLES:
        if role in character_map.roles and role not in not_in_fk:
            kind, arm = ControlKind.HIPS if role == "hips" else ControlKind.FK, None
            if role in FINGER_ROLES:
                kind, arm = ControlKind.FINGER, f"arm.{role[-1]}"
            pairs = zip(character_map.keyed_bones(role), character_map.bones(role), strict=True)
            wanted += [(control, kind, bone, arm) for control, bone in pairs]
    if character is not None and "hips" not in character_map.left_alone:
        hips = next((name for name in character_map.keyed_bones("hips") if name in character.index), None)
        bone = None if hips is None else character.bone(hips)
        while bone is not None and bone.connected and bone.parent >= 0:
            bone = character.bones[bone.parent]
        if bone is not None and bone.name != hips:
            wanted.append((bone.name, ControlKind.CARRIER, bone.name, None))
    found: dict[str, PlannedControl] = {}
    for name, kind, moved, belongs in wanted:
        if name is not None and moved is not None:
            found.setdefault(name, PlannedControl(name, kind, moved, belongs))
    return tuple(found.values())


def limb_keys(character_map: CharacterMap, options: RetargetOptions, limb: str) -> LimbKeys:
    """How a limb is keyed: as chosen, where the rig and the parts that may be moved allow it."""
    moved = set(character_map.roles) - set(character_map.left_alone)
    if limb not in character_map.ik or not set(JOINTS[limb]) <= moved:
        return LimbKeys.FK
    if all(control is None for role in JOINTS[limb][:2] for control in character_map.keyed_bones(role)):
        return LimbKeys.IK
    return options.arms if limb.startswith("arm") else options.legs


def limb_bones(character_map: CharacterMap, limb: str) -> tuple[str, str, str]:
    """The bones that begin at a limb's three joints."""
    first, second, third = (str(character_map.bone(role)) for role in JOINTS[limb])
    return first, second, third


NOTHING = -1  # instead of the index of a control: the armature itself
RIGID = 1e-3  # residual [rad, or shares of the character's size] below which a space is rigid


@dataclass(frozen=True, eq=False)
class ControlSpace:
    """The space in which a control's channels act."""

    turner: int  # index of the control that turns it; NOTHING for none
    turn: Array  # (3, 3) the axes of its rotation channels, in those of its turner (of the armature)
    carrier: int  # index of the control that carries it; NOTHING for none
    origin: Array  # (3,) its place without location channels, in its carrier's axes from its carrier's head
    axes: Array  # (3, 3) takes its location channels to its carrier's axes
    residual_rad: float  # largest turn that the space does not explain
    residual: float  # largest distance that it does not explain, in the armature's units

    def placed_by_turner(self, origin: Array) -> "ControlSpace":
        """The space where the turner carries it at a place (3,) in its axes, and locations do nothing."""
        return replace(self, carrier=self.turner, origin=origin, axes=np.zeros((3, 3)), residual=0.0)

    @property
    def movable(self) -> bool:
        """Whether its location channels place it."""
        # Least length of the axes of location channels that do something.
        return bool(np.linalg.svd(self.axes, compute_uv=False)[-1] > 1e-3)


@dataclass(frozen=True, eq=False)
class PosedControls:
    """Controls as posed at random, in S samples; the first of them without any location."""

    channels: Array  # (S, C, 4, 4) each control's own rotation and location
    poses: Array  # (S, C, 4, 4) its pose in the armature's space; scale is ignored
    still: int  # number of samples without location channels, at least two; four more have some


def chosen(posed: PosedControls, indices: Sequence[int]) -> PosedControls:
    """Some of the controls."""
    rows = list(indices)
    return replace(posed, channels=posed.channels[:, rows], poses=posed.poses[:, rows])


def find_spaces(posed: PosedControls) -> tuple[ControlSpace, ...]:
    """The space of every control."""
    turns, places = unscaled(posed.poses[..., :3, :3]), posed.poses[..., :3, 3]
    axes = turns @ np.swapaxes(posed.channels[..., :3, :3], -1, -2)  # (S, C, 3, 3)
    inverse = np.swapaxes(turns, -1, -2)[:, :, None]
    # A control is turned by what its own rotation axes change least in the axes of,
    seen = inverse @ axes[:, None]  # (S, turner, control, 3, 3)
    turners = _least(_spread(seen, (-2, -1)), _spread(axes, (-2, -1)))
    # and carried by what its place without location changes least from.
    still = places[: posed.still]
    apart = still[:, None] - still[:, :, None]  # (still, carrier, control, 3)
    seen = (inverse[: posed.still] @ apart[..., None])[..., 0]
    carriers = _least(_spread(seen, (-1,)), _spread(still, (-1,)))
    spaces = []
    for control, (turner, carrier) in enumerate(zip(turners, carriers, strict=True)):
        own, place = axes[:, control], places[:, control]
        if turner != NOTHING:
            own = np.swapaxes(turns[:, turner], -1, -2) @ own
        turn, residual_rad = constant_turn(own)
        if carrier != NOTHING:
            way = (place - places[:, carrier])[..., None]
            place = (np.swapaxes(turns[:, carrier], -1, -2) @ way)[..., 0]
        origin = place[: posed.still].mean(axis=0)
        moved, shift = posed.channels[posed.still :, control, :3, 3], place[posed.still :] - origin
        location_axes = np.linalg.lstsq(moved, shift, rcond=1e-6)[0].T
        left = np.concatenate([place[: posed.still] - origin, shift - moved @ location_axes.T])
        residual = float(np.linalg.norm(left, axis=-1).max())
        spaces.append(ControlSpace(turner, turn, carrier, origin, location_axes, residual_rad, residual))
    return tuple(spaces)


def unscaled(matrices: Array) -> Array:
    """(..., 3, 3) with columns of length one."""
    return np.asarray(matrices / np.maximum(np.linalg.norm(matrices, axis=-2, keepdims=True), 1e-12))


def constant_turn(turns: Array) -> tuple[Array, float]:
    """The turn (3, 3) nearest to all of (S, 3, 3), and the largest angle to one of them [rad]."""
    mean = nearest_rotation(turns.mean(axis=0)[None])[0]
    return mean, float(np.linalg.norm(rotations.logarithm(mean.T @ turns), axis=-1).max())


def _spread(values: Array, axis: tuple[int, ...]) -> Array:
    """Largest distance from the mean over the samples, which lead."""
    return np.asarray(np.sqrt(((values - values.mean(axis=0)) ** 2).sum(axis=axis)).max(axis=0))


def _least(others: Array, nothing: Array) -> list[int]:
    """Row of the least of (C, C) but the diagonal in each column; NOTHING where (C,) is less."""
    others = others + np.where(np.eye(len(others), dtype=bool), np.inf, 0.0)
    row = others.argmin(axis=0)
    less = others[row, np.arange(len(row))] < nothing
    return [int(index) if taken else NOTHING for index, taken in zip(row, less, strict=True)]


def rigid_offset(leading: Array, following: Array) -> tuple[Array, float, float]:
    """The mean pose (4, 4) without scale of a following bone (S, 4, 4) in the axes of the leading one.

    With it come the largest turn [rad] and the largest distance [the poses' unit] by which a sample differs.
    """
    axes = np.swapaxes(unscaled(leading[:, :3, :3]), -1, -2)
    turn, turn_rad = constant_turn(axes @ unscaled(following[:, :3, :3]))
    places = (axes @ (following[:, :3, 3] - leading[:, :3, 3])[..., None])[..., 0]
    offset = np.eye(4)
    offset[:3, :3], offset[:3, 3] = turn, places.mean(axis=0)
    return offset, turn_rad, float(np.linalg.norm(places - offset[:3, 3], axis=-1).max())


ALWAYS_MOVED = (ControlKind.HIPS, ControlKind.GOAL, ControlKind.POLE, ControlKind.ROOT, ControlKind.CARRIER)
"""Kinds of controls that are placed wherever they can be."""


@dataclass(frozen=True, eq=False)
class Control:
    """A bone that is keyed, and how its channels act."""

    plan: PlannedControl
    mode: str  # its rotation mode
    space: ControlSpace  # its space; turner and carrier are indices among all controls
    turns: bool  # whether its rotation is keyed
    displaced: bool = False  # whether it has a location already, which a motion must replace

    @property
    def name(self) -> str:
        """The bone's name."""
        return self.plan.name


@dataclass(frozen=True, eq=False)
class ControlChannels:
    """A control over F frames."""

    rotation: Array | None  # (F, 3, 3) its rotation channels as a turn from rest; None for none
    location: Array | None  # (F, 3) its location channels; None where they are not keyed
    turn: Array  # (F, 3, 3) its axes in the armature's space, as the channels give them
    place: Array  # (F, 3) its head in the armature's space, as the channels give it


def ordered_controls(controls: Sequence[Control]) -> tuple[Control, ...]:
    """The controls in an order in which those that turn or carry others come before them.

    Where they would turn each other in a circle, which no rigid space does, one of them is taken as free.
    """
    order: list[int] = []

    def visit(index: int, above: frozenset[int]) -> None:
        if index == NOTHING or index in order or index in above:
            return
        space = controls[index].space
        for other in (space.turner, space.carrier):
            visit(other, above | {index})
        order.append(index)

    for index in range(len(controls)):
        visit(index, frozenset())
    place = {index: number for number, index in enumerate(order)} | {NOTHING: NOTHING}
    found = []
    for number, index in enumerate(order):
        space = controls[index].space
        turner, carrier = (
            above if above < number else NOTHING for above in (place[space.turner], place[space.carrier])
        )
        residual = space.residual if carrier == place[space.carrier] else np.inf
        space = replace(space, turner=turner, carrier=carrier, residual=residual)
        found.append(replace(controls[index], space=space))
    return tuple(found)


def control_channels(
    controls: Sequence[Control],
    wanted: Mapping[str, Array],
    size: float,
    known: Mapping[int, ControlChannels] = MappingProxyType({}),
) -> tuple[ControlChannels, ...]:
    """The channels that give controls the poses (F, 4, 4) they are to have, or the nearest that they can.

    Controls that turn or carry others come before them; channels in `known`, by index, stay. Poses are in the
    armature's space, the character's size in its units; of a pole only the place counts.
    """
    frames = len(next(iter(wanted.values()), np.zeros((1, 4, 4))))
    still, origin = np.broadcast_to(np.eye(3), (frames, 3, 3)), np.zeros((frames, 3))
    found: list[ControlChannels] = []
    for index, control in enumerate(controls):
        if index in known:
            found.append(known[index])
            continue
        space, pose = control.space, wanted[control.name]
        turner = still if space.turner == NOTHING else found[space.turner].turn
        axes, place = still, origin
        if space.carrier != NOTHING:
            axes, place = found[space.carrier].turn, found[space.carrier].place
        turn = turner @ space.turn
        rotation = None
        if control.turns:
            rotation = np.swapaxes(turn, -1, -2) @ unscaled(pose[:, :3, :3])
            turn = turn @ rotation
        place = place + axes @ space.origin
        goal = pose[:, :3, 3]
        for hips in controls if control.plan.kind in (ControlKind.ROOT, ControlKind.CARRIER) else ():
            held = hips.plan.kind is ControlKind.HIPS and hips.space.carrier == index
            if held and not hips.space.movable:  # it must place hips that cannot be placed themselves
                goal = wanted[hips.name][:, :3, 3] - turn @ hips.space.origin
        apart = goal - place
        location = None
        # Share of the character's size from which a bone that usually only turns is moved as well.
        must = control.displaced or np.linalg.norm(apart, axis=-1).max() > 0.005 * size
        if space.movable and (must or control.plan.kind in ALWAYS_MOVED):
            local = (np.swapaxes(axes, -1, -2) @ apart[..., None])[..., 0]
            location = np.linalg.solve(space.axes, local.T).T
        if location is not None or space.residual >= RIGID * size:  # where none can tell, as wanted
            place = goal
        found.append(ControlChannels(rotation, location, turn, place))
    return tuple(found)
