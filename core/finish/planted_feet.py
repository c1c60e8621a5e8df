"""Contacts of feet, where an ankle is slow, near one place and low, and feet that are held there."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, IndexArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..estimate.block_banded import BlockBanded
from .rig import Rig

RELEASE_SPEED_M_S = 0.25  # below this a foot may rest; once it must be slower than half of it
NEIGHBORHOOD_S = 1.0
STRAY_M = 0.025  # largest distance of a resting ankle's estimate from its place


@dataclass(frozen=True, eq=False)
class Contact:
    """A foot at rest."""

    point: int  # index of the point that rests
    first: int  # the first frame of the rest, from 0
    last: int  # its last frame, included
    place: Array  # (3,) its place [m]


def find_contacts(places: Array, time_s: Array, stray_m: float = STRAY_M) -> tuple[Contact, ...]:
    """Find the contacts of points (F, N, 3) [m], in order of point and frame.

    No floor is assumed: a foot may rest on a step or a beam. One that sways or slides farther than it may
    stray does not rest. A rest on a step begins when the point comes there, though its way there still tells
    that it is high.
    """
    if len(places) < 3:
        return ()
    speed = np.linalg.norm(np.gradient(places, time_s, axis=0), axis=-1)
    found: list[Contact] = []
    for point in range(places.shape[1]):
        path, own = places[:, point], speed[:, point]
        # On stairs a foot that carries the body may be high, while the other one is faster than this.
        carries = np.delete(speed, point, axis=1).max(axis=1, initial=0.0) > 0.5
        may_rest = carries | _is_low(path, time_s)
        free = 0
        for run in _slow_runs(own, may_rest):
            first, last = _longest_rest(path, stray_m, *run)
            lasted, whole = time_s[last] - time_s[first], time_s[run[1]] - time_s[run[0]]
            # Shortest rest; shorter ones are turning points of a moving foot.
            # Least share of a slow run that a rest takes; a foot that is slow but does not stay slides.
            if lasted >= max(0.2, 0.6 * whole):
                place = path[first : last + 1].mean(axis=0)
                near = np.linalg.norm(path - place, axis=-1) <= stray_m
                rest = _widened(~may_rest & near & (own < RELEASE_SPEED_M_S), first, last, free)
                found.append(Contact(point, *rest, place))
                free = rest[1] + 1
    return tuple(found)


def _is_low(path: Array, time_s: Array) -> BoolArray:
    """(F,) whether a point is near its own lowest."""
    low = np.array(
        [path[np.abs(time_s - now) <= NEIGHBORHOOD_S, 2].min() for now in time_s], dtype=np.float64
    )
    return np.asarray(path[:, 2] - low < 0.05)


def _widened(stays: BoolArray, first: int, last: int, free: int) -> tuple[int, int]:
    """The range of frames (first, last) with the frames from `free` on beside it in which the point stays."""
    while first > free and stays[first - 1]:
        first -= 1
    while last < len(stays) - 1 and stays[last + 1]:
        last += 1
    return first, last


def _slow_runs(speed: Array, may_rest: BoolArray) -> list[tuple[int, int]]:
    """Runs of frames (first, last) that stay below the release speed and somewhere rest."""
    slow = (speed < RELEASE_SPEED_M_S) & may_rest
    edges = np.flatnonzero(np.diff(np.concatenate([[0], slow.astype(np.intp), [0]])))
    runs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(int(a), int(b)) for a, b in runs if speed[a : b + 1].min() < 0.12]


def _longest_rest(path: Array, stray_m: float, first: int, last: int) -> tuple[int, int]:
    """The longest part of a run that stays near its own mean place."""
    longest = (first, first)
    start = first
    for stop in range(first + 1, last + 1):
        while not _stays(path[start : stop + 1], stray_m):
            start += 1
        if stop - start > longest[1] - longest[0]:
            longest = (start, stop)
    return longest


def _stays(path: Array, stray_m: float) -> bool:
    return bool((np.linalg.norm(path - path.mean(axis=0), axis=-1) <= stray_m).all())


# --- Foot planting


FADE_S = 0.2  # time in which a correction fades on either side of a rest
ANKLE_STD_M = 2e-4  # standard deviation of an ankle from its target
CHANGE_STD = {"pelvis.location": 0.005, "hip": 0.1, "knee": 0.1, "shin": 0.03}
"""Standard deviation of the change of each degree of freedom [m, rad]: legs before hips, bends before
twists."""
RESTING_TOLERANCE_M = 0.0005  # most that key reduction may move a resting ankle: it must not slide
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
    """Hold resting feet still, by their mean place; postures far from any rest are unchanged."""
    ankles = [body.skeleton.point_names.index(f"ankle.{side}") for side in SIDES]
    places = body.points(body.pose(posture))[:, ankles]
    contacts = find_contacts(places, time_s, stray_m)
    yield 0.1
    if not contacts:
        return PlantedFeet(posture, ())
    target, touched = _targets(places, contacts, time_s)
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


def point_tolerances(rig: Rig, frame_count: int, tolerance_m: float, contacts: Sequence[Contact]) -> Array:
    """(F, P) tolerance of each of the rig's points [m], less for resting ankles and soles."""
    allowed = np.full((frame_count, rig.point_slices[-1].stop), tolerance_m)
    row = {bone.name: index for index, bone in enumerate(rig.bones)}
    for contact in contacts:
        frames, side = slice(contact.first, contact.last + 1), SIDES[contact.point]
        ankle = rig.point_slices[row[f"shin.{side}"]].start + 1
        allowed[frames, ankle] = min(RESTING_TOLERANCE_M, tolerance_m)
        if f"foot.{side}" in row:
            foot = rig.point_slices[row[f"foot.{side}"]]
            allowed[frames, foot.start] = min(RESTING_TOLERANCE_M, tolerance_m)
            allowed[frames, foot.start + 1 : foot.stop] = min(SOLE_TOLERANCE_M, tolerance_m)
    return allowed


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
