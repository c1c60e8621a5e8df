"""Feet that are held where they rest and above the ground on their way."""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..body.human import ANKLES
from ..body.kinematics import Body
from ..body.posture import Posture
from ..body.skeleton import SIDES
from ..numerics.block_banded import BlockBanded
from .contacts import STRAY_M, Contact, find_contacts
from .fading import Hold, faded
from .soles import Shins, Soles, ground_of

ANKLE_STD_M = 2e-4  # standard deviation of an ankle from its target
CHANGE_STD = {"pelvis.location_": 0.005, "hip.": 0.1, "knee.": 0.1, "shin.": 0.03}
"""Standard deviation of the change of degrees of freedom, by how they begin [m, rad]: legs before hips, bends
before twists."""


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
    pose = body.pose(posture)
    places = body.points(pose)[:, ANKLES]
    contacts = find_contacts(places, time_s, stray_m)
    yield 0.1
    if not contacts:
        return PlantedFeet(posture, ())
    target = places.copy()
    for point in range(len(SIDES)):
        own = [contact for contact in contacts if contact.point == point]
        holds = [Hold(contact.first, contact.place - places[contact.frames, point]) for contact in own]
        target[:, point] += faded(holds, time_s)
    # Feet that could lie flat are out of the ground; a resting foot is where it rests.
    lowest = ground_of(body, pose, time_s, contacts).height_m + Soles.of(body).clearance_m(
        Shins.of(body, pose)
    )
    for contact in contacts:
        lowest[contact.frames, contact.point] = -np.inf
    target[..., 2] = np.maximum(target[..., 2], lowest)
    touched = (target != places).any(axis=(1, 2))
    names, kinds = body.skeleton.dof_names, CHANGE_STD.items()
    changed = {dof: std for dof, name in enumerate(names) for kind, std in kinds if name.startswith(kind)}
    dofs, std = np.array(list(changed), dtype=np.intp), np.array(list(changed.values()))
    frames, size = len(time_s), len(dofs)
    # Factor of `CHANGE_STD` in frames without a correction.
    unchanged = (std * np.where(touched, 1.0, 1e-6)[:, None]) ** -2
    # Changes that change little from frame to frame: knees do not flicker.
    steady = (std * 2.0 * np.maximum(np.diff(time_s), 1e-3)[:, None]) ** -2
    prior = BlockBanded(frames, size)
    prior.add_combination(slice(None), (1.0,), unchanged)
    prior.add_combination(slice(None), (-1.0, 1.0), steady)
    delta = np.zeros((frames, size))
    planted = posture
    for number in range(8):  # steps of Gauss and Newton
        moved = body.pose(planted)
        residual = (body.points(moved)[:, ANKLES] - target).reshape(frames, -1) / ANKLE_STD_M
        jacobian = body.points_jacobian(moved)[:, ANKLES][..., dofs].reshape(frames, -1, size) / ANKLE_STD_M
        equations = BlockBanded(frames, size)
        equations.add_rows((jacobian,))
        equations.add(prior)
        gradient = (residual[:, None] @ jacobian)[:, 0] + prior.multiply(delta)
        step = equations.factorize().solve(-gradient)
        delta += step
        full = np.zeros((frames, body.skeleton.dof_count))
        full[:, dofs] = delta
        planted = Posture.where(touched, posture.plus(full), posture)
        yield 0.1 + 0.9 * (number + 1) / 8
        if np.abs(step).max() < 1e-5:
            break
    return PlantedFeet(planted, contacts)
