"""What the pictures tell of the body's contours, once the markers have told roughly where it is.

From some frames it is learned how the parts of the body and the background look; from the keyframes, where
the posture is known best, how thick the parts are and where they sit; then edges are measured everywhere.
"""

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, BoolArray, Image, IndexArray, chunks
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.appearance import Appearance, learn_appearance
from ..footage.camera import Camera
from ..footage.clips.album import Album
from ..observation.contours import SHAPE, ContourModel, ContourPrediction
from ..observation.part_map import part_map
from .contour_search import Edges, find_edges
from .keyframe_evidence import evenly_chosen
from .terms.contours import PIXEL_STD, SURFACE_SHARE, ContourTerm
from .terms.term import student_weight

LEARNED_FRAMES = 32
CHUNK_FRAMES = 50
MOST_KEYFRAMES = 60
"""Of more keyframes, this many, evenly spread in time, show the shapes."""
ROUNDS = 3
SHAPE_STD_M = np.array([0.010, 0.010, 0.008, 0.008])
"""How far a performer's parts are from average ones: thickness at both ends, and place."""
EDGE_STD_M = 0.012
FEWEST_EDGES = 20
FEWEST_SEEN = 0.1
"""Share of the frames in which something must be to be seen."""
DEGREES = 4.0


@dataclass(frozen=True, eq=False)
class ContourEvidence:
    """What is needed to find the contours in any of a clip's frames."""

    album: Album
    """Pictures of the frames."""
    appearance: Appearance
    """How performer and background look."""
    model: ContourModel
    """The contours of the performer's own parts."""

    def term(self, posture: Posture, frame: IndexArray) -> Generator[float, None, ContourTerm]:
        """Measure the edges near the contours of F postures, as far as they are known.

        It yields the fraction done.

        Args:
            posture: The F postures.
            frame: (F,) their places in the clip.
        """
        model, album = self.model, self.album
        edge = np.full((len(frame), len(model.part_of), 2), np.nan)
        normal, variance = np.zeros_like(edge), np.ones(edge.shape[:2])
        for chunk in chunks(np.arange(len(frame)), CHUNK_FRAMES):
            pictures = album.pictures(frame[chunk])
            predicted, edges = _look(model, album, self.appearance, posture[chunk], frame[chunk], pictures)
            found = np.isfinite(edges.variance)
            place = predicted.pixel + edges.distance[..., None] * predicted.normal
            edge[chunk] = np.where(found[..., None], place, np.nan)
            normal[chunk] = predicted.normal
            variance[chunk] = edges.variance + (PIXEL_STD * album.factor) ** 2
            yield (chunk[-1] + 1) / len(frame)
        return ContourTerm(model, edge, normal, variance)


def learn_contours(
    body: Body, camera: Camera, album: Album, posture: Posture, keyframes: IndexArray
) -> Generator[None, None, ContourEvidence | None]:
    """Learn how performer and background look, and the shapes of the performer's parts.

    It yields now and then, so that whoever waits can stop waiting.

    Args:
        body: The actor's body.
        camera: The camera.
        album: Pictures of the clip's frames.
        posture: The postures of all F frames as far as they are known.
        keyframes: Frames whose posture is known best.

    Returns:
        None where no background can be trusted: before a moving camera, or where most pictures are missing.
    """
    seen = np.array([index in album for index in range(posture.batch[0])])
    keyframes = keyframes[seen[keyframes]]
    if camera.is_moving or np.mean(seen) < FEWEST_SEEN or len(keyframes) == 0:
        return None
    frame = np.flatnonzero(seen)
    model = ContourModel.average(body, camera)
    appearance = yield from _learn(model, album, posture[frame], frame)
    if not appearance.steady:
        return None
    known = keyframes[evenly_chosen(keyframes, MOST_KEYFRAMES)]
    fitted = yield from _fitted(model, album, appearance, posture[known], known)
    return ContourEvidence(album, appearance, fitted)


def _learn(
    model: ContourModel, album: Album, posture: Posture, frame: IndexArray
) -> Generator[None, None, Appearance]:
    count = min(LEARNED_FRAMES, len(frame))
    chosen = np.unique(np.round((np.arange(count) + 0.5) * len(frame) / count - 0.5).astype(np.intp))
    parts = model.part_outlines(model.body.pose(posture[chosen]), frame[chosen])
    images = [album.picture(int(index)) for index in frame[chosen]]
    size = images[0].shape[1], images[0].shape[0]
    yield
    labels = [part_map(parts, i, size, album.factor) for i in range(len(chosen))]
    yield
    return learn_appearance(images, labels, len(model.parts.segments))


def _look(
    model: ContourModel,
    album: Album,
    appearance: Appearance,
    posture: Posture,
    frame: IndexArray,
    pictures: tuple[Image, BoolArray],
) -> tuple[ContourPrediction, Edges]:
    pose = model.body.pose(posture)
    predicted = model.evaluate(pose, frame)
    image, known = pictures
    edges = find_edges(model, predicted, pose, frame, image, album.factor, appearance)
    edges.distance[~known], edges.variance[~known] = 0.0, np.inf
    return predicted, edges


def _fitted(
    model: ContourModel, album: Album, appearance: Appearance, posture: Posture, frame: IndexArray
) -> Generator[None, None, ContourModel]:
    """The model with shapes that explain the edges of postures known best."""
    stretches = chunks(np.arange(len(frame)), CHUNK_FRAMES)
    pictures = [album.pictures(frame[chunk]) for chunk in stretches]
    for _ in range(ROUNDS):
        known = []
        for chunk, seen in zip(stretches, pictures, strict=True):
            yield
            known.append(_look(model, album, appearance, posture[chunk], frame[chunk], seen))
        model = model.with_shape(_fitted_shape(model, known, album.factor))
    return model


def _fitted_shape(model: ContourModel, known: list[tuple[ContourPrediction, Edges]], factor: int) -> Array:
    """(O, SHAPE) corrections that best explain edges found where the posture is known."""
    rate = np.concatenate([predicted.shape_rate for predicted, _ in known])
    width = np.concatenate([predicted.half_width for predicted, _ in known])
    distance = np.concatenate([edges.distance for _, edges in known])
    variance = np.concatenate([edges.variance for _, edges in known])
    variance = variance + (PIXEL_STD * factor) ** 2 + (0.5 * SURFACE_SHARE * width) ** 2
    shape = np.zeros_like(model.shape)
    for part in np.unique(model.part_of):
        own = (model.part_of == part) & np.isfinite(variance)
        if np.count_nonzero(own) < FEWEST_EDGES:
            continue
        rows, noise = rate[own], variance[own]
        wanted = distance[own] + rows @ model.shape[part]
        scale = np.linalg.norm(rows[:, :2], axis=-1)  # about the pixels of a meter
        weight = student_weight(distance[own] ** 2 / (noise + (EDGE_STD_M * scale) ** 2), DEGREES, 1) / noise
        normal = rows.T @ (weight[:, None] * rows) + np.diag(SHAPE_STD_M**-2)
        shape[part] = np.linalg.solve(normal, rows.T @ (weight * wanted))
    assert shape.shape[1] == SHAPE
    return shape
