"""Edits of a take's found keyframes: candidates stored, postures keyed on the actor."""

from collections.abc import Sequence
from math import pi

import numpy as np
from bpy.types import PropertyGroup

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.human import HUMAN, TRUNK, limb_of
from ...core.body.kinematics import Body
from ...core.body.posture import Posture, headings_rad, yaw_rotation
from ..bridge.actions import assign_action
from ..bridge.keyframes import candidate_posture, write_matched
from ..shell.keyed_frames import new_keyframe_action, straighten_unposed
from ..shell.takes import actor_of
from .found_properties import PLACE_VALUES

ANYBODY = Body(Actor.from_stature(1.7))  # The body on which candidates are compared; its size hardly matters
ELSEWHERE_M = 0.15
"""Distance between joints of two candidates above which anybody sees that a limb is elsewhere [m]."""


def add_match(take: PropertyGroup, frame: float, library: str) -> PropertyGroup:
    """Add a found keyframe without candidates, in order of frame; others may move in memory."""
    matches = take.matching.matches
    place = sum(match.frame < frame for match in matches)
    match = matches.add()
    match.frame, match.library = frame, library
    matches.move(len(matches) - 1, place)
    return matches[place]


def add_candidate(
    match: PropertyGroup, posture: Posture, name: str, mirrored: bool, confidence: float
) -> None:
    """Add a posture that a found keyframe's frame may show; the first one added is the one it has."""
    candidate = match.candidates.add()
    candidate.name, candidate.mirrored, candidate.confidence = name, mirrored, confidence
    vector = posture.to_vector()
    candidate.place, candidate.turns = vector[:PLACE_VALUES], vector[PLACE_VALUES:]
    first = candidate_posture(match.candidates[0])
    apart = _heading(posture) - _heading(first)
    candidate.turned = (apart + pi) % (2.0 * pi) - pi
    candidate.limbs = " ".join(_limbs_elsewhere(posture, first, apart))


def _limbs_elsewhere(posture: Posture, first: Posture, apart_rad: float) -> list[str]:
    """Limbs whose joints are elsewhere on the body than the first posture's, which faces another way."""
    back = yaw_rotation(-apart_rad)
    own, other = (ANYBODY.points(ANYBODY.pose(each)) - each.translation for each in (posture, first))
    distance = np.linalg.norm(own @ back.T - other, axis=-1)
    elsewhere = {
        limb_of(name) for name, far in zip(HUMAN.point_names, distance > ELSEWHERE_M, strict=True) if far
    }
    return sorted(elsewhere - {TRUNK})


def _heading(posture: Posture) -> float:
    """The heading of a single posture [rad]."""
    return float(headings_rad(Posture.stack([posture]))[0])


def key_matches(take: PropertyGroup, frames: Array, postures: Sequence[Posture]) -> None:
    """Key postures at scene frames (K,) as found ones, and assign the keyframes to the actor."""
    actor = actor_of(take)
    take.keyframe_action = take.keyframe_action or new_keyframe_action(actor)
    write_matched(actor, take.keyframe_action, frames, postures)
    straighten_unposed(take)
    assign_action(actor, take.keyframe_action)


def key_candidate(take: PropertyGroup, match: PropertyGroup) -> None:
    """Key the chosen candidate of a found keyframe at its frame."""
    key_matches(take, np.array([round(match.frame, 3)]), [candidate_posture(match.candidate)])
