"""Match of one library with a clip: posture, heading, place and confidence of every frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.posture import Posture
from ..footage.region_tracks import RegionTracks
from ..library.library import Library
from ..numerics.robust import student_weight
from ..prior.interpolation import interpolate
from ..prior.keyframes import Keyframe
from ..progress import Part, scaled
from .candidates import MatchedFrame, frame_candidates
from .coarse_pass import FLOOR_STD_M, floor_height_m
from .emissions import FrameEmissions, StateFeatures, evaluate_emissions, state_features, with_exchanged
from .frame_likelihood import FrameLikelihood, frame_likelihoods
from .hidden_markov_model import HiddenMarkovModel
from .marker_moments import MarkerMoments, marker_moments
from .match_input import MatchInput
from .noise_scales import DEGREES_OF_FREEDOM, NoiseScales
from .posture_sequences import PostureSequences, library_sequences
from .refinement import ContinuousPath, Refinement
from .sequence_table import SequenceTable
from .state_path import StatePath

HEADINGS = 24
FRAMES_A_YIELD = 16
SAMPLES_PER_S = 15.0
"""Rate at which a clip is sampled: between samples this near a motion's posture is well known."""
CORRELATION_S = 0.25
"""Time over which a performer's difference from the library stays the same: frames nearer count less each."""


@dataclass(frozen=True, eq=False)
class LibraryMatch:
    """The most probable sequence of a library's postures in a clip."""

    library: Library
    frames: tuple[MatchedFrame, ...]
    """The frames proposed for keyframes, in order."""
    fit: float
    """Mean share of the footage that is explained, 0 to 1."""
    floor_m: float
    """Height of the floor that the performer stands on."""
    postures: Posture
    """(F,) the match's posture in every frame of the clip."""


@dataclass(frozen=True, eq=False)
class PreparedLibrary:
    """A library on the performer's body."""

    library: Library
    sequences: PostureSequences
    moments: MarkerMoments
    states: StateFeatures


def prepare_library(match_input: MatchInput, library: Library) -> PreparedLibrary:
    """Put a library on the performer's body."""
    sequences = library_sequences(library, match_input.body)
    moments = marker_moments(match_input.body, match_input.evidence, sequences.posture)
    return PreparedLibrary(library, sequences, moments, state_features(moments, HEADINGS))


def match_library(
    match_input: MatchInput, prepared: PreparedLibrary, floor_m: float | None
) -> Part[LibraryMatch]:
    """Find a library's postures in footage.

    Args:
        match_input: The take; posed keyframes tell the height of the floor where it is not known.
        prepared: The library, see `prepare_library`.
        floor_m: Height of the floor [m]; None where it is not known.

    Yields:
        The fraction done.
    """
    evidence, tracks, posed = match_input.evidence, match_input.evidence.tracks, match_input.constraints
    sampled = sampled_frames(tracks, np.concatenate([match_input.keyframes, posed.frames]))
    if floor_m is None:
        floor_m = posed.floor_m()
    if floor_m is None:
        floor_m = floor_height_m(match_input.camera, evidence, sampled, prepared.states)
    weight = tempering(tracks.time_s[sampled])
    table = SequenceTable(prepared.sequences, prepared.moments)
    unit = NoiseScales.of(evidence)
    first = yield from _solve(match_input, prepared, table, sampled, floor_m, weight, unit, 0.0)
    noise_scales = first.refinement.noise_scales(first.refined)
    second = yield from _solve(match_input, prepared, table, sampled, floor_m, weight, noise_scales, 0.45)
    posteriors = yield from scaled(second.model.forward_backward(), 0.9, 1.0)
    refined = second.refined
    postures = _every_frame(table, refined, sampled, tracks.frame_count)
    explained = _explained_share(second.refinement, refined, noise_scales)
    nearest = table.nearest(refined.sequence, refined.values[:, 0])
    frames = []
    for row in map(int, np.searchsorted(sampled, match_input.keyframes)):
        index, share = int(sampled[row]), float(explained[row])
        chosen = frame_candidates(
            second.path, posteriors[row], row, index, postures[index], int(nearest[row]), share
        )
        frames.append(chosen)
    fit = float(explained.mean())
    return LibraryMatch(prepared.library, tuple(frames), fit, floor_m, postures)


@dataclass(frozen=True, eq=False)
class _Solution:
    """The hidden Markov model with its Viterbi path, and the refinement of that."""

    model: HiddenMarkovModel
    path: StatePath
    refinement: Refinement
    refined: ContinuousPath


def _solve(
    match_input: MatchInput,
    prepared: PreparedLibrary,
    table: SequenceTable,
    sampled: IndexArray,
    floor_m: float,
    weight: float,
    noise_scales: NoiseScales,
    begun: float,
) -> Part[_Solution]:
    """Find and refine the most probable path, given the noise scales; 0.45 of the work."""
    evidence, states = match_input.evidence, prepared.states
    time_s, posed = evidence.tracks.time_s[sampled], match_input.constraints
    hypotheses = list(
        zip(
            *(
                frame_likelihoods(
                    match_input.camera, each, sampled, floor_m, FLOOR_STD_M, noise_scales, posed
                )
                for each in ((evidence, evidence.exchanged()) if len(evidence.points) else (evidence,))
            ),
            strict=True,
        )
    )
    likelihoods = [hypothesis[0] for hypothesis in hypotheses]
    costs = [posed.cost(int(frame), prepared.moments.points, states.heading_rad) for frame in sampled]
    # Frames are tempered, as neighbors say much the same; a posed keyframe says its own once.
    posed_costs = [None if cost is None else cost / np.float32(weight) for cost in costs]
    emissions = yield from scaled(_evaluate_all(hypotheses, states, posed_costs), begun, begun + 0.2)
    model = HiddenMarkovModel(prepared.sequences, states, likelihoods, emissions, weight, time_s)
    yield from scaled(model.add_transitions(), begun + 0.2, begun + 0.3)
    best = yield from scaled(model.viterbi(), begun + 0.3, begun + 0.35)
    likelihoods = [
        hypothesis[int(emission.exchanged[emission.index_of(state)])]
        for hypothesis, emission, state in zip(hypotheses, emissions, best, strict=True)
    ]
    path = StatePath(prepared.sequences, states, likelihoods, emissions, best, time_s)
    rows = np.searchsorted(sampled, posed.frames)
    refinement = Refinement(table, likelihoods, time_s, weight, floor_m, FLOOR_STD_M, posed, rows)
    refined = yield from scaled(refinement.refine(path.continuous()), begun + 0.35, begun + 0.45)
    return _Solution(model, path, refinement, refined)


def _evaluate_all(
    hypotheses: Sequence[Sequence[FrameLikelihood]],
    states: StateFeatures,
    posed_costs: Sequence[SingleArray | None],
) -> Part[list[FrameEmissions]]:
    """Emissions of each frame; with keypoints the second hypothesis is that left and right are exchanged."""
    emissions = []
    for index, (hypothesis, cost) in enumerate(zip(hypotheses, posed_costs, strict=True)):
        found = [evaluate_emissions(likelihood, states, cost) for likelihood in hypothesis]
        emissions.append(found[0] if len(found) == 1 else with_exchanged(found[0], found[1]))
        if index % FRAMES_A_YIELD == 0:
            yield index / len(hypotheses)
    return emissions


def tempering(time_s: Array) -> float:
    """Weight of each of several frames at some times (T,): what makes one doubtful makes its neighbors so."""
    return min(1.0, float(np.median(np.diff(time_s))) / CORRELATION_S)


def sampled_frames(tracks: RegionTracks, keyframes: Sequence[int] | IndexArray) -> IndexArray:
    """Sampled frames: evenly spaced ones, the first, the last and the keyframes."""
    count = tracks.frame_count
    duration = float(tracks.time_s[-1] - tracks.time_s[0]) / max(count - 1, 1)
    stride = max(1, round(1.0 / SAMPLES_PER_S / duration)) if duration > 0.0 else 1
    return np.unique(np.concatenate([np.arange(0, count, stride), [count - 1], keyframes])).astype(np.intp)


def _every_frame(table: SequenceTable, path: ContinuousPath, frames: IndexArray, frame_count: int) -> Posture:
    """(F,) postures of the whole clip."""
    time, heading, hips = path.values[:, 0], path.values[:, 1], path.values[:, 2:]
    found = table.posture(path.sequence, time, heading, hips)
    keyframes = [Keyframe(int(frame), found[row]) for row, frame in enumerate(frames)]
    return interpolate(tuple(keyframes), frame_count)


def _explained_share(refinement: Refinement, path: ContinuousPath, noise_scales: NoiseScales) -> Array:
    """(T,) mean weight of the places of markers and keypoints in each frame under Student's t.

    Args:
        refinement: Its last refinement.
        path: The refined path.
        noise_scales: Those that the refinement used.
    """
    residual, *_ = refinement.residuals(path.sequence, path.values, np.ones(len(noise_scales.size)))
    squared = ((residual * noise_scales.centroid[:, None]) ** 2).sum(axis=-1)
    visible = np.array([likelihood.visible for likelihood in refinement.likelihoods])
    weight = visible * student_weight(squared, DEGREES_OF_FREEDOM, 1)
    return np.asarray(weight.sum(axis=1) / np.maximum(visible.sum(axis=1), 1))
