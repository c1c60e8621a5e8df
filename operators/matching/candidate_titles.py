"""Titles of candidates: in what each differs from the first one."""

from math import degrees

import bpy

from ...core.library.several_libraries import COMPOSED
from ..shell.messages import label

NOTICEABLE_TURN_DEG = 15.0
LIMBS = {"arm.L": "left arm", "arm.R": "right arm", "leg.L": "left leg", "leg.R": "right leg"}
"""As a candidate's property names them, and in words; pairs are named together."""
PAIRS = {("arm.L", "arm.R"): "arms", ("leg.L", "leg.R"): "legs"}


def candidate_title(match: bpy.types.PropertyGroup, candidate: bpy.types.PropertyGroup) -> str:
    """What tells a candidate from the first one: its turn, then the name of its posture.

    Postures that were composed have the name of one that they resemble, which often is the same for all:
    instead the limbs are named that are elsewhere.
    """
    angle, what = degrees(candidate.turned), str(candidate.name)
    if match.library == COMPOSED and candidate.limbs:
        what = label("other {limbs}", limbs=", ".join(_limbs(candidate.limbs.split())))
    if abs(angle) < NOTICEABLE_TURN_DEG:
        return what[:1].upper() + what[1:]
    if abs(angle) > 180.0 - NOTICEABLE_TURN_DEG:
        return label("Turned round: {posture}", posture=what)
    if angle > 0.0:
        return label("{angle:.0f}° left: {posture}", angle=angle, posture=what)
    return label("{angle:.0f}° right: {posture}", angle=-angle, posture=what)


def _limbs(names: list[str]) -> list[str]:
    """Words for limbs, both of a pair together."""
    words = []
    for pair, both in PAIRS.items():
        there = [name for name in pair if name in names]
        words += [label(both)] if len(there) == len(pair) else [label(LIMBS[name]) for name in there]
    return words
