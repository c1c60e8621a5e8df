"""What is learned once the markers are followed, before contours join them.

In this order, since each step stands on those before it: which way round the body turns, how large the motion
is, how the performer and the background look, and where markers are that were lost. Each changes the problem,
and the states follow it.
"""

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
from .warm_start import changed_gaps
from .windows import Window


def refine(
    problem: ClipProblem,
    spans: list[Window],
    states: list[ClipState],
    album: Album | None,
    anew: BoolArray,
    contours: ContourEvidence | None,
    earlier: ClipProblem | None = None,
) -> Part[tuple[ClipProblem, list[ClipState], ContourEvidence | None]]:
    """Learn from the footage what the keyframes could not tell.

    Args:
        problem: The clip's problem.
        spans: The windows.
        states: The state of each by its markers.
        album: Pictures of all frames; None where contours are left out.
        anew: (F,) the frames that are decided anew, and with them the gaps between keyframes they lie in.
        contours: What is known of contours already; None to learn it.
        earlier: The problem of an earlier estimate, which knows the rest; None without one.

    Yields:
        The fraction done, from 0 to 1.

    Returns:
        Problem and states with all that was learned, and the look of performer and background; None where no
        background can be trusted.
    """
    problem, states = yield from scaled(choose_turns(problem, states, changed_gaps(problem, anew)), 0.0, 0.3)
    problem, states = yield from scaled(adapted(problem, spans, states, anew, earlier), 0.3, 0.4)
    if earlier is None and contours is not None:
        contours = contours.with_camera(problem.evidence.model.camera)
    elif earlier is None and album is not None:
        contours = yield from scaled(_learned(problem, spans, states, album), 0.4, 0.5)
    if contours is not None and len(problem.evidence.model.placements):
        looking = find_lost(problem, spans, states, contours, anew)
        problem = yield from scaled(looking, 0.5, 1.0)
    return problem, states, contours


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
