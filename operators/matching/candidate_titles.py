"""Titles of candidates: in what each differs from the first one."""

from math import degrees

import bpy

from ..shell.messages import label

NOTICEABLE_TURN_DEG = 15.0


def candidate_title(candidate: bpy.types.PropertyGroup) -> str:
    """A candidate's name, after its turn: several often differ by that alone, and a sidebar is narrow."""
    angle = degrees(candidate.turned)
    if abs(angle) < NOTICEABLE_TURN_DEG:
        return str(candidate.name)
    if abs(angle) > 180.0 - NOTICEABLE_TURN_DEG:
        return label("Turned round: {posture}", posture=candidate.name)
    if angle > 0.0:
        return label("{angle:.0f}° left: {posture}", angle=angle, posture=candidate.name)
    return label("{angle:.0f}° right: {posture}", angle=-angle, posture=candidate.name)
