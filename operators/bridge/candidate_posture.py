"""Postures of candidates, as a scene's properties hold them."""

import bpy
import numpy as np

from ...core.body.human import HUMAN
from ...core.body.posture import Posture


def candidate_posture(candidate: bpy.types.PropertyGroup) -> Posture:
    """The posture of a found keyframe's candidate, in the world."""
    return Posture.from_vector(HUMAN, np.array([*candidate.place, *candidate.turns]))
