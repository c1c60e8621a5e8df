"""Rests of the feet that the footage shows, which a corrected keyframe amid found ones does not tear.

A keyframe that a person put right lies beside frames whose evidence has a foot a little elsewhere. Feet that
move from frame to frame are released, so the one frame would jump there and back. Where feet rest is
therefore asked before the keyframe is believed, and holds afterwards: the correction moves the whole rest.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array
from .clip_problem import ClipProblem
from .clip_state import ClipState, Window
from .keyframe_error import match_covariance
from .terms.assembly import stillness_term


def without_corrections(problem: ClipProblem) -> ClipProblem:
    """The problem with every keyframe as doubtful as a found one; the same where all are, or none is."""
    decided = ~problem.matched | problem.corrected
    if not problem.matched.any() or not decided.any():
        return problem
    information = problem.evidence.information.copy()
    frame = problem.keyframes[decided]
    information[decided] = np.linalg.inv(match_covariance(problem.prior[frame], problem.camera, frame))
    evidence = replace(problem.evidence, information=information)
    return replace(problem, evidence=evidence, corrected=np.zeros_like(decided))


def rests_of(problem: ClipProblem, spans: list[Window], states: list[ClipState]) -> Array:
    """(F - 1, 2) how far each ankle stands in the states of some windows, 0 to 1; 0 elsewhere."""
    rests = np.zeros((problem.frames - 1, 2))
    for window, state in zip(spans, states, strict=True):
        rests[window.first : window.last - 1] = stillness_term(problem, window).standing(state)
    return rests
