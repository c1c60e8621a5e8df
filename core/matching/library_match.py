"""A library found in footage: which of its postures is seen when and where, in which heading, how surely."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from ..footage.region_tracks import RegionTracks
from ..library.library import Library
from ..prior.interpolation import interpolate
from ..prior.keyframes import Keyframe
from ..progress import Part, scaled
from .candidates import alternatives
from .candidate import MatchedFrame
from .coarse_pass import FLOOR_STD_M, Glance, glance
from .emissions import Fit, Turned, sweep, turned
from .frame_likelihood import Sight, sights
from .hidden_markov_model import Lattice
from .marker_moments import Solids, marker_solids
from .noise_scales import DEGREES, Habits
from .posed_constraints import Anchors
from .posture_sequences import Chains, library_chains
from .refinement import Course, Refinement
from .sequence_table import CourseTable
from .state_path import Path

HEADINGS = 24
SWEPT_AT_ONCE = 16
SAMPLES_PER_S = 15.0
"""Frames looked at: a motion's posture is known well between two that are this near."""
CORRELATION_S = 0.25
"""So long a performer is off the library's posture in the same way: frames nearer tell less each."""


@dataclass(frozen=True, eq=False)
class Sought:
    """What is looked at: everything of a take that a match needs."""

    body: Body
    camera: Camera
    tracks: RegionTracks
    segments: tuple[str, ...]
    """The segment of each marker."""
    keyframes: IndexArray
    """(K,) frames to be told the posture of."""
    anchors: Anchors
    """What is posed."""


@dataclass(frozen=True, eq=False)
class LibraryMatch:
    """A library's way through a clip."""

    library: Library
    frames: tuple[MatchedFrame, ...]
    """The frames proposed for keyframes, in order."""
    fit: float
    """How well the footage is explained, 0 to 1."""
    floor_m: float
    """Height of the floor that the performer was placed on."""
    course: Posture
    """(F,) what the match says of every frame of the clip."""
    log_evidence: float
    """Logarithm of the probability of what an independent frame shows, up to a constant of the footage."""


@dataclass(frozen=True, eq=False)
class Prepared:
    """A library on the performer's body, and a first look with it."""

    library: Library
    chains: Chains
    solids: Solids
    states: Turned
    sampled: IndexArray
    """(T,) the frames to look at."""
    glance: Glance


def prepare(sought: Sought, library: Library) -> Prepared:
    """Put a library on the performer's body and look at a few frames with it."""
    chains = library_chains(library, sought.body)
    solids = marker_solids(sought.body, sought.segments, chains.posture)
    states = turned(solids, HEADINGS)
    return Prepared(library, chains, solids, states, *_first_look(sought, states))


def prepared_anew(sought: Sought, prepared: Prepared) -> Prepared:
    """The library on the same body, with a first look at other tracks."""
    sampled, first = _first_look(sought, prepared.states)
    return replace(prepared, sampled=sampled, glance=first)


def _first_look(sought: Sought, states: Turned) -> tuple[IndexArray, Glance]:
    told = np.concatenate([sought.keyframes, sought.anchors.frames])
    sampled = sampled_frames(sought.tracks, told)
    return sampled, glance(sought.camera, sought.tracks, sought.segments, sampled, states)


def match_library(sought: Sought, prepared: Prepared, floor_m: float) -> Part[LibraryMatch]:
    """Find a library's postures in footage.

    Args:
        sought: The take.
        prepared: The library, see `prepare`.
        floor_m: Height of the floor.

    Yields:
        The fraction that is done.
    """
    tracks, sampled = sought.tracks, prepared.sampled
    chains, states = prepared.chains, prepared.states
    time_s = tracks.time_s[sampled]
    tempering = min(1.0, float(np.median(np.diff(time_s))) / CORRELATION_S)
    table = CourseTable(chains, prepared.solids)
    habits = Habits.unknown(len(sought.segments))
    anchors, anchored = sought.anchors, np.searchsorted(sampled, sought.anchors.frames)
    like = [anchors.cost(int(frame), prepared.solids.points, states.heading_rad) for frame in sampled]
    # The footage is tempered, as frames say much the same; what is posed is said once.
    posed = [None if cost is None else cost / np.float32(tempering) for cost in like]
    for look in (0, 1):  # the second look knows how the performer differs from the library
        seen = sights(sought.camera, tracks, sought.segments, sampled, floor_m, FLOOR_STD_M, habits, anchors)
        begun = 0.45 * look
        fits = yield from scaled(_swept(seen, states, posed), begun, begun + 0.2)
        lattice = Lattice(chains, states, seen, fits, tempering, time_s)
        yield from scaled(lattice.connect(), begun + 0.2, begun + 0.3)
        best = yield from scaled(lattice.best_path(), begun + 0.3, begun + 0.35)
        path = Path(chains, states, seen, fits, best, time_s)
        refinement = Refinement(table, seen, time_s, tempering, floor_m, FLOOR_STD_M, anchors, anchored)
        refined = yield from scaled(refinement.refined(path.course()), begun + 0.35, begun + 0.45)
        if look == 0:
            habits = refinement.habits(refined)
    shares, evidence = yield from scaled(lattice.posterior(), 0.9, 1.0)
    course = _every_frame(table, refined, sampled, tracks.frame_count)
    explained = _explained(refinement, refined, habits)
    likelihood = evidence / (len(sampled) * tempering)
    nearest = table.nearest(refined.chain, refined.values[:, 0])
    frames = []
    for row in np.searchsorted(sampled, sought.keyframes):
        index, part = int(sampled[row]), float(explained[row])
        chosen = course[index]
        frames.append(alternatives(path, shares[row], int(row), index, chosen, int(nearest[row]), part))
    fit = float(explained.mean())
    return LibraryMatch(prepared.library, tuple(frames), fit, floor_m, course, likelihood)


def _swept(seen: Sequence[Sight], states: Turned, posed: Sequence[SingleArray | None]) -> Part[list[Fit]]:
    """The states that explain each frame."""
    fits = []
    for index, (sight, cost) in enumerate(zip(seen, posed, strict=True)):
        fits.append(sweep(sight, states, cost))
        if index % SWEPT_AT_ONCE == 0:
            yield index / len(seen)
    return fits


def sampled_frames(tracks: RegionTracks, keyframes: Sequence[int] | IndexArray) -> IndexArray:
    """The frames to look at: evenly spaced, the first, the last and the keyframes."""
    count = tracks.frame_count
    duration = float(tracks.time_s[-1] - tracks.time_s[0]) / max(count - 1, 1)
    stride = max(1, round(1.0 / SAMPLES_PER_S / duration)) if duration > 0.0 else 1
    return np.unique(np.concatenate([np.arange(0, count, stride), [count - 1], keyframes])).astype(np.intp)


def _every_frame(table: CourseTable, course: Course, frames: IndexArray, frame_count: int) -> Posture:
    """(F,) postures of the whole clip."""
    time, heading, hips = course.values[:, 0], course.values[:, 1], course.values[:, 2:]
    found = table.posture(course.chain, time, heading, hips)
    keyframes = [Keyframe(int(frame), found[row]) for row, frame in enumerate(frames)]
    return interpolate(tuple(keyframes), frame_count)


def _explained(refinement: Refinement, course: Course, habits: Habits) -> Array:
    """(T,) mean weight of the markers' middles in each frame: one weighs less the farther it is off.

    Args:
        refinement: What the course was refined by.
        course: The course.
        habits: Of the performer, as the refinement has them.
    """
    off, _, _ = refinement.residuals(course.chain, course.values, np.ones(len(habits.size)))
    squared = ((off * habits.middle[:, None]) ** 2).sum(axis=-1)
    seen = np.array([sight.seen for sight in refinement.sights])
    weight = seen / (1.0 + squared / DEGREES)
    return np.asarray(weight.sum(axis=1) / np.maximum(seen.sum(axis=1), 1))
