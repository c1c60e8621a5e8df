"""Feet that are held where they rest and above the ground on their way, and what few keys may make of it."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body, Pose
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..numerics.block_banded import BlockBanded
from .contacts import STRAY_M, Contact, find_contacts
from .foot_ground import Shins, Soles, find_ground, on_ground
from .rig import Rig

FADE_S = 0.2  # time in which a correction fades on either side of a rest
ANKLE_STD_M = 2e-4  # standard deviation of an ankle from its target
CHANGE_STD = {"pelvis.location": 0.005, "hip": 0.1, "knee": 0.1, "shin": 0.03}
"""Standard deviation of the change of each degree of freedom [m, rad]: legs before hips, bends before
twists."""
RESTING_TOLERANCE_M = 0.0005  # most that key reduction may move a resting ankle: it must not slide
FLOOR_TOLERANCE_M = (
    0.0015  # the same of a sole that is near the ground but does not rest: it must not pass it
)
NEAR_GROUND_M = 0.03  # height up to which a sole is near the ground
SOLE_TOLERANCE_M = 0.001  # largest error that it may give heel and tip of a resting foot [m], which lies flat
ITERATIONS = 8


@dataclass(frozen=True, eq=False)
class PlantedFeet:
    """A motion whose resting feet stand still."""

    posture: Posture  # a batch of F postures
    contacts: tuple[Contact, ...]  # where which ankle rests; points are counted left, right


def plant_feet(
    body: Body, posture: Posture, time_s: Array, stray_m: float = STRAY_M
) -> Generator[float, None, PlantedFeet]:
    """Hold resting feet still, by their mean place, and moving ones out of the ground between their rests.

    Postures far from any rest and above the ground are unchanged.
    """
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    pose = body.pose(posture)
    places = body.points(pose)[:, ankles]
    contacts = find_contacts(places, time_s, stray_m)
    yield 0.1
    if not contacts:
        return PlantedFeet(posture, ())
    target, touched = _targets(places, contacts, time_s)
    lift = _out_of_ground_m(body, pose, contacts, time_s)
    target[..., 2] += lift
    touched |= (lift > 0.0).any(axis=1)
    dofs = _free_dofs(body)
    std = np.array([CHANGE_STD[_kind(body.skeleton.dof_names[dof])] for dof in dofs])
    delta = np.zeros((len(time_s), len(dofs)))
    planted = posture
    for number in range(ITERATIONS):
        step = _gauss_newton_step(body, planted, ankles, target, touched, dofs, std, delta, time_s)
        delta += step
        full = np.zeros((len(time_s), body.skeleton.dof_count))
        full[:, dofs] = delta
        planted = Posture.where(touched, posture.plus(full), posture)
        yield 0.1 + 0.9 * (number + 1) / ITERATIONS
        if np.abs(step).max() < 1e-5:
            break
    return PlantedFeet(planted, contacts)


def _out_of_ground_m(body: Body, pose: Pose, contacts: Sequence[Contact], time_s: Array) -> Array:
    """(F, 2) how much higher the ankles must be for feet that could lie flat to be out of the ground [m]."""
    standing = on_ground(contacts)
    if not standing:
        return np.zeros((len(time_s), 2))
    shins, soles = Shins.of(body, pose), Soles.of(body)
    floor = find_ground(shins, soles, time_s, standing).floor_m
    needed = np.maximum(floor + soles.clearance_m(shins) - shins.ankle[..., 2], 0.0)
    for contact in contacts:  # a resting foot is where it rests
        needed[contact.first : contact.last + 1, contact.point] = 0.0
    return needed


def point_tolerances(
    rig: Rig,
    frame_count: int,
    tolerance_m: float,
    contacts: Sequence[Contact],
    near_ground: BoolArray | None = None,
) -> Array:
    """(F, P) tolerance of each of the rig's points [m], less for resting ankles and soles.

    `near_ground` (F, 2) says where a sole that moves is near the ground.
    """
    allowed = np.full((frame_count, rig.point_slices[-1].stop), tolerance_m)
    row = {bone.name: index for index, bone in enumerate(rig.bones)}
    for side, near in zip(SIDES, () if near_ground is None else near_ground.T, strict=False):
        soles = sole_rows(rig, side)
        allowed[np.ix_(near, soles)] = min(FLOOR_TOLERANCE_M, tolerance_m)
    for contact in contacts:
        frames, side = slice(contact.first, contact.last + 1), SIDES[contact.point]
        ankle = rig.point_slices[row[f"shin.{side}"]].start + 1
        allowed[frames, ankle] = min(RESTING_TOLERANCE_M, tolerance_m)
        if f"foot.{side}" in row:
            foot = rig.point_slices[row[f"foot.{side}"]]
            allowed[frames, foot.start] = min(RESTING_TOLERANCE_M, tolerance_m)
            allowed[frames, foot.start + 1 : foot.stop] = min(SOLE_TOLERANCE_M, tolerance_m)
    return allowed


def sole_rows(rig: Rig, side: str) -> IndexArray:
    """Which of a rig's points are heel and tip of a foot; none where it has no bone of its own."""
    row = {bone.name: index for index, bone in enumerate(rig.bones)}
    if f"foot.{side}" not in row:
        return np.zeros(0, dtype=np.intp)
    foot = rig.point_slices[row[f"foot.{side}"]]
    return np.arange(foot.start + 1, foot.stop)


def _free_dofs(body: Body) -> IndexArray:
    """Degrees of freedom that may change: the hips' place and the legs."""
    names = body.skeleton.dof_names
    return np.array([i for i, name in enumerate(names) if _kind(name) in CHANGE_STD], dtype=np.intp)


def _kind(name: str) -> str:
    """`hip.L.rotation_x` is of the kind `hip`, `pelvis.location_x` of the kind `pelvis.location`."""
    first, *_, last = name.split(".")
    return f"{first}.{last.partition('_')[0]}" if first == "pelvis" else first


def _targets(places: Array, contacts: tuple[Contact, ...], time_s: Array) -> tuple[Array, BoolArray]:
    """Target of each ankle (F, 2, 3), and the frames in which it differs from before."""
    target = places.copy()
    touched = np.zeros(len(time_s), dtype=bool)
    for contact in contacts:
        beside = [other for other in contacts if other.point == contact.point and other is not contact]
        point, rest = contact.point, slice(contact.first, contact.last + 1)
        target[rest, point] = contact.place
        touched[rest] = True
        for edge, way in ((contact.first, -1), (contact.last, 1)):
            near = [
                abs(time_s[other.last if way < 0 else other.first] - time_s[edge])
                for other in beside
                if (other.first - contact.first) * way > 0
            ]
            # Two rests that follow closely share the time between them.
            fade = min([FADE_S, *(0.5 * gap for gap in near)])
            offset = contact.place - places[edge, point]
            frame = edge + way
            while 0 <= frame < len(time_s) and abs(time_s[frame] - time_s[edge]) < fade:
                share = abs(time_s[frame] - time_s[edge]) / fade
                target[frame, point] += offset * (1.0 - share) ** 2 * (1.0 + 2.0 * share)
                touched[frame] = True
                frame += way
    return target, touched


def _gauss_newton_step(
    body: Body,
    posture: Posture,
    ankles: list[int],
    target: Array,
    touched: BoolArray,
    dofs: IndexArray,
    std: Array,
    delta: Array,
    time_s: Array,
) -> Array:
    """A Gauss-Newton step (F, n) of the changes `delta`."""
    frames, size = delta.shape
    pose = body.pose(posture)
    residual = (body.points(pose)[:, ankles] - target).reshape(frames, -1) / ANKLE_STD_M
    jacobian = body.points_jacobian(pose)[:, ankles][..., dofs].reshape(frames, -1, size) / ANKLE_STD_M
    equations = BlockBanded(frames, size)
    equations.add_rows((jacobian,))
    gradient = (residual[:, None] @ jacobian)[:, 0]
    every = slice(None)
    # Factor of `CHANGE_STD` in frames without a correction.
    unchanged = (std * np.where(touched, 1.0, 1e-6)[:, None]) ** -2
    # Changes that change little from frame to frame: knees do not flicker.
    steady = (std * 2.0 * np.maximum(np.diff(time_s), 1e-3)[:, None]) ** -2
    prior = BlockBanded(frames, size)
    prior.add_combination(every, (1.0,), unchanged)
    prior.add_combination(every, (-1.0, 1.0), steady)
    equations.add(prior)
    gradient += prior.multiply(delta)
    return equations.factorize().solve(-gradient)
