"""What is learned once the markers are followed, before contours join them.

In this order, since each step stands on those before it: which way round the body turns, how the performer
and the background look, where markers are that were lost, and how large the motion is. Each changes the
problem, and the states follow it.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import BoolArray
from ..body.posture import Posture
from ..footage.clips.album import Album
from ..progress import Part, scaled
from .clip_problem import ClipProblem
from .clip_state import ClipState
from .contour_evidence import ContourEvidence, learn_contours
from .contour_schedule import contour_schedule
from .motion_size import adapted
from .second_look import find_lost
from .turn_choice import choose_turns
from .undecided import Undecided
from .windows import Window


@dataclass(frozen=True, eq=False)
class Refinement:
    """A clip's problem and the states of its windows, with all that was learned from the footage."""

    problem: ClipProblem
    states: list[ClipState]
    contours: ContourEvidence | None = None
    """The look of performer and background; None where no background can be trusted."""
    undecided: tuple[Undecided, ...] = ()
    """Stretches in which the body may have turned another way."""


@dataclass(frozen=True, eq=False)
class Anew:
    """What is decided anew; an earlier estimate is right about the rest."""

    frames: BoolArray
    """(F,)."""
    gaps: BoolArray
    """(K - 1,) gaps between keyframes."""

    @classmethod
    def everything(cls, problem: ClipProblem) -> "Anew":
        """All of a clip."""
        return cls(np.ones(problem.frames, dtype=bool), np.ones(len(problem.turns), dtype=bool))


def refine(
    problem: ClipProblem,
    spans: list[Window],
    states: list[ClipState],
    album: Album | None,
    anew: Anew,
    contours: ContourEvidence | None,
    earlier: ClipProblem | None = None,
) -> Part[Refinement]:
    """Learn from the footage what the keyframes could not tell.

    Args:
        problem: The clip's problem.
        spans: The windows.
        states: The state of each by its markers.
        album: Pictures of all frames; None where contours are left out.
        anew: What is decided anew.
        contours: What is known of contours already; None to learn it.
        earlier: The problem of an earlier estimate, which knows the rest; None without one.

    Yields:
        The fraction done, from 0 to 1.
    """
    turns = yield from scaled(choose_turns(problem, states, anew.gaps), 0.0, 0.3)
    problem, states = turns.problem, turns.states
    problem, states = yield from scaled(adapted(problem, spans, states, anew.frames, earlier), 0.3, 0.4)
    if earlier is None and contours is not None:
        contours = contours.with_camera(problem.evidence.model.camera)
    elif earlier is None and album is not None:
        contours = yield from scaled(_learned(problem, spans, states, album), 0.4, 0.5)
    if contours is not None and len(problem.evidence.model.placements):
        looking = find_lost(problem, spans, states, contours, anew.frames)
        problem = yield from scaled(looking, 0.5, 0.7)
        # What was found may decide a turn that was open, and a turn shows where to look.
        still_open = _open_gaps(problem, turns.undecided)
        if still_open.any():
            again = yield from scaled(choose_turns(problem, states, still_open), 0.7, 0.75)
            kept = tuple(one for one in turns.undecided if not still_open[_gap(problem, one)])
            turns = replace(again, undecided=(*kept, *again.undecided))
            if (again.problem.turns != problem.turns).any():
                problem, states = again.problem, again.states
                looking = find_lost(problem, spans, states, contours, anew.frames)
                problem = yield from scaled(looking, 0.75, 0.8)
    problem, states = yield from scaled(adapted(problem, spans, states, anew.frames, earlier), 0.9, 1.0)
    return Refinement(problem, states, contours, turns.undecided)


def _gap(problem: ClipProblem, one: Undecided) -> int:
    """The gap between keyframes that a stretch lies in."""
    return int(np.searchsorted(problem.keyframes, one.frame[0], side="right")) - 1


def _open_gaps(problem: ClipProblem, undecided: tuple[Undecided, ...]) -> BoolArray:
    """(K - 1,) gaps that turn the short way though another is nearly as probable."""
    gaps = np.zeros(len(problem.turns), dtype=bool)
    for one in undecided:
        gaps[_gap(problem, one)] = problem.turns[_gap(problem, one)] == 0
    return gaps


def _learned(
    problem: ClipProblem, spans: list[Window], states: list[ClipState], album: Album
) -> Part[ContourEvidence | None]:
    """The look of performer and background, and the shapes of the performer's parts."""
    camera = problem.evidence.model.camera  # with the lens that was found
    segments = tuple(one.segment for one in problem.evidence.model.placements)
    schedule = contour_schedule(
        problem.body, camera, album.factor, segments, problem.prior, problem.keypoints
    )
    posture = _kept(spans, states)
    learning = learn_contours(problem.body, camera, album, posture, problem.keyframes, schedule)
    return (yield from scaled(learning, 0.0, 1.0))


def _kept(spans: list[Window], states: list[ClipState]) -> Posture:
    """The postures of all frames."""
    return Posture.concatenate(
        [state.posture[window.kept] for state, window in zip(states, spans, strict=True)]
    )
