"""What the families share: a window of the picture as a network takes it, and the points that it sees.

Whoever is in the picture is found by Keymark's own pose network, about whose points the window lies.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import cv2
import numpy as np

from ...arrays import Array, Image, SingleArray
from ...errors import InputError, describe_unexpected
from ..layouts import Layout
from ..network_file import network_input
from ..onnx_file import HALF, KINDS, OnnxFile, Tensor
from ..pose_network import Look, in_parallel

MEAN = np.array([0.485, 0.456, 0.406]).reshape(3, 1, 1)
STD = np.array([0.229, 0.224, 0.225]).reshape(3, 1, 1)
"""Of the pictures of ImageNet by channel, red first, of 0 to 1; others write them as 123.675, ... of 255."""
LARGEST_SIDE_PX, MOST_NUMBERS = 1024, 2**24
MARGIN = 0.06
"""By which a person reaches beyond the points of one, as a share of the larger side of the box about them."""


@dataclass(frozen=True, eq=False)
class Box:
    """A box about a person, upright, which may reach beyond the picture."""

    center: Array  # (2,) [px]
    size: Array  # (2,) width and height [px]

    @classmethod
    def about(cls, points: Array) -> "Box":
        """The box about a person's points (N, 2) [px], of which NaN are not seen."""
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        margin = MARGIN * float((high - low).max())
        return cls(0.5 * (low + high), np.maximum(high - low + 2.0 * margin, 2.0))


@dataclass(frozen=True, eq=False)
class Window:
    """What of a picture a network sees, all of it alike reduced or enlarged."""

    corner: Array  # (2,) its outer corner at the top left [px]
    scale: float  # the picture's pixels to one of the network's

    @classmethod
    def around(cls, box: Box, share: float, size: tuple[int, int]) -> "Window":
        """The smallest about a box, so many times as large, in a network's `size`, width and height."""
        scale = share * float((box.size / np.array(size)).max())
        return cls(box.center - 0.5 * scale * np.array(size), scale)

    def pixel(self, place: Array) -> Array:
        """Places in the picture by those in the network's (..., 2), both from outer corners [px]."""
        return np.asarray(self.corner + self.scale * place)

    def cut(self, picture: Image, size: tuple[int, int]) -> SingleArray:
        """The network's picture (1, 3, height, width), red first, normalized; black beyond the picture."""
        matrix = np.column_stack([self.scale * np.eye(2), self.corner])
        seen = network_input(picture, matrix, *size, cv2.BORDER_CONSTANT)
        return np.asarray((seen - MEAN) / STD, dtype=np.float32)


@dataclass(frozen=True, eq=False)
class Signature:
    """What families are known by: a file, and its outputs as they are when it runs."""

    file: OnnxFile
    inputs: tuple[Tensor, ...]  # with one picture
    outputs: tuple[Tensor, ...]

    @property
    def size(self) -> tuple[int, int] | None:
        """Width and height of the picture that goes in first [px]; None where none does."""
        first = self.inputs[0].shape
        whole = len(first) == 4 and first[1] == 3 and all(length is not None for length in first)
        return (first[3] or 0, first[2] or 0) if whole else None


class Network(ABC):
    """A network that somebody brought, of one family."""

    KNOWN: ClassVar[str]  # what is known of the family, for sentences
    SHARE: ClassVar[float]  # side of what it sees by that of the box
    motion: bool = False
    """Whether its points in space are a motion to refer to, and no mere hints of depth."""

    def __init__(self, signature: Signature, title: str, layout: Layout) -> None:
        assert signature.size is not None
        self.file, self.size, self.layout = signature.file, signature.size, layout
        self._inputs, self._shapes = signature.inputs, [one.shape for one in signature.outputs]
        width, height = self.size
        self.name = f"{title}, {layout.count} points, {height} x {width}"
        self.session: Any = None

    @classmethod
    @abstractmethod
    def recognize(cls, signature: Signature) -> "Network | None":
        """The network, where it is one of this family."""

    def prepare(self, picture: Image, box: Box) -> tuple[Window, Sequence[SingleArray]]:
        """What the network sees of a picture (height, width, 3), blue first, and its inputs."""
        window = Window.around(box, self.SHARE, self.size)
        return window, [window.cut(picture, self.size)]

    @abstractmethod
    def read(self, outputs: Sequence[Array], window: Window) -> Look:
        """The person, by the outputs in the file's order."""

    def each(self, looks: Sequence[tuple[Image, Box]]) -> list[Look]:
        """The persons in boxes of pictures."""
        return in_parallel(self._look, looks)

    def _look(self, look: tuple[Image, Box]) -> Look:
        window, values = self.prepare(*look)
        outputs = run(self.session, self.file.path, self._inputs, values)
        if [output.shape for output in outputs] != self._shapes:
            raise InputError(f"{self.file.path}: gives other shapes for one picture than for another")
        return self.read(outputs, window)


def run(session: Any, path: Path, inputs: Sequence[Tensor], values: Sequence[SingleArray]) -> list[Array]:
    """What a network gives.

    Raises:
        InputError: It cannot be run, or gives too much or what are no numbers.
    """
    feed = {
        one.name: np.asarray(value, dtype=np.float16 if one.kind == HALF else np.float32)
        for one, value in zip(inputs, values, strict=True)
    }
    try:
        outputs = session.run(None, feed)
    except Exception as error:  # onnxruntime's own kinds of error have no base of their own
        raise InputError(f"{path}: cannot be run ({describe_unexpected(error)[:200]})") from error
    for output in outputs:
        if not isinstance(output, np.ndarray) or output.dtype.kind != "f" or output.size > MOST_NUMBERS:
            raise InputError(f"{path}: gives something else than at most {MOST_NUMBERS} decimal numbers")
        if not np.isfinite(output).all():
            raise InputError(f"{path}: gives values that are no numbers; a network must give finite ones")
    return [np.asarray(output, dtype=np.float64) for output in outputs]


def refuse_inputs(file: OnnxFile) -> None:
    """Refuse a file whose inputs no known network has: one picture and a few numbers.

    Raises:
        InputError: They are others.
    """
    for one in file.inputs:
        lengths = one.shape[1:]
        fits = all(length is not None and length <= LARGEST_SIDE_PX for length in lengths)
        if one.kind not in KINDS or not lengths or not fits or one.shape[0] not in (None, 1):
            raise InputError(
                f"{file.path}: takes {one.words}; a network must take one picture of fixed size, at most "
                f"{LARGEST_SIDE_PX} pixels wide and high, as float or half"
            )


def peaks(values: Array) -> tuple[Array, Array]:
    """Places (K,) of the maxima of rows (K, B), finer than a bin, and their values (K,)."""
    at, rows = values.argmax(axis=-1), np.arange(len(values))
    inner = np.clip(at, 1, values.shape[-1] - 2)
    around = values[rows[:, None], inner[:, None] + [-1, 0, 1]]
    return at + np.where(at == inner, vertex(*around.T), 0.0), values[rows, at]


def vertex(before: Array, here: Array, after: Array) -> Array:
    """Places of maxima beside bins, from those and their neighbors: at most half a bin.

    Of a parabola through the logarithms, exact for Gaussians (Zhang et al. 2020, "Distribution-Aware
    Coordinate Representation for Human Pose Estimation").
    """
    before, here, after = (np.log(np.maximum(one, 1e-6)) for one in (before, here, after))
    bend = np.minimum(before - 2.0 * here + after, -1e-9)
    return np.clip(0.5 * (before - after) / bend, -0.5, 0.5)
