"""Networks in ONNX files for tests: they find colored dots by soft-argmax, and say so as a family does."""

from collections.abc import Callable, Sequence
from itertools import islice, product
from pathlib import Path

import cv2
import numpy as np
import onnx
from _synthetic_take import BODY, CAMERA, true_postures
from keymark.core.arrays import Array, Image
from keymark.core.camera.camera import Camera
from keymark.core.detect.layouts import LAYOUTS, Layout
from keymark.core.detect.pose_network import CIRCLE, LAYOUT, Crop, Pose
from keymark.core.files.json_file import read_json
from keymark.core.video.clip import Clip
from onnx import TensorProto, helper, numpy_helper

MEAN, STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)
SPREAD, FAINTEST = 0.02, 0.3
"""Of a color that still counts as a dot's own, and the least share of it in a pixel that does."""
COLORS = np.array([each for each in product((0.0, 1 / 3, 2 / 3, 1.0), repeat=3) if max(each) == 1.0])
"""(37, 3) red first: none is another one with some black, as at the edges of dots."""
METERS = 1.7
"""Height of what a network sees, for networks that guess places in space."""


class Graph:
    """A graph that is written operator by operator, each of one output."""

    def __init__(self, half: bool = False) -> None:
        self.nodes: list[onnx.NodeProto] = []
        self.constants: list[onnx.TensorProto] = []
        self.kind = TensorProto.FLOAT16 if half else TensorProto.FLOAT
        self.dtype = np.float16 if half else np.float32

    def constant(self, value: object, dtype: type | None = None) -> str:
        name = f"c{len(self.constants)}"
        array = np.asarray(value, dtype=dtype or np.float32)
        self.constants.append(numpy_helper.from_array(array, name))
        return name

    def __call__(self, kind: str, *inputs: object, name: str = "", **attributes: object) -> str:
        out = name or f"v{len(self.nodes)}"
        names = [one if isinstance(one, str) else self.constant(one) for one in inputs]
        self.nodes.append(helper.make_node(kind, names, [out], **attributes))
        return out

    def total(self, value: str, *axes: int, keep: int = 0) -> str:
        return self("ReduceSum", value, self.constant(axes, np.int64), keepdims=keep)

    def write(
        self, path: Path, inputs: dict[str, Sequence[object]], outputs: dict[str, Sequence[object]]
    ) -> Path:
        described = [
            [helper.make_tensor_value_info(name, self.kind, shape) for name, shape in part.items()]
            for part in (inputs, outputs)
        ]
        graph = helper.make_graph(self.nodes, "dots", *described, self.constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
        onnx.save(model, path)
        return path


def _found(
    graph: Graph, picture: str, size: tuple[int, int], count: int, numbers: Sequence[int]
) -> list[str]:
    """Column and row (1, K) of each dot in the pixels' own numbers, and whether it is there."""
    width, height = size
    colors, sent = COLORS[: len(numbers)], np.eye(count)[list(numbers)]
    whole = graph("Cast", picture, to=TensorProto.FLOAT)
    scaled = graph("Mul", whole, np.reshape(STD, (1, 3, 1, 1)))
    seen = graph("Add", scaled, np.reshape(MEAN, (1, 3, 1, 1)))
    square = graph.total(graph("Mul", seen, seen), 1, keep=1)
    length = np.linalg.norm(colors, axis=1)
    along = graph("Conv", seen, (colors / length[:, None])[:, :, None, None])
    off = graph("Sub", square, graph("Mul", along, along))
    share = graph(
        "Div", graph("Sub", graph("Div", along, length.reshape(1, -1, 1, 1)), FAINTEST), 1.0 - FAINTEST
    )
    share = graph("Min", graph("Relu", share), 1.0)
    weight = graph("Mul", share, graph("Exp", graph("Div", off, -(SPREAD**2))))
    total = graph("Add", graph.total(weight, 2, 3), 1e-6)
    places = [
        graph("Div", graph.total(graph("Mul", weight, own), 2, 3), total)
        for own in (np.arange(width).reshape(1, 1, 1, -1), np.arange(height).reshape(1, 1, -1, 1))
    ]
    found = [*places, graph("Div", total, graph("Add", total, 1.0))]
    return [graph("MatMul", one, sent) for one in found]


def _bell(graph: Graph, place: str, bins: int, std: float, axes: Sequence[int] = (2,)) -> str:
    """Gaussians (1, K, bins) about places (1, K)."""
    off = graph("Sub", graph("Unsqueeze", place, graph.constant(axes, np.int64)), np.arange(bins))
    return graph("Exp", graph("Div", graph("Mul", off, off), -2.0 * std**2))


def simcc(
    path: Path, count: int, numbers: Sequence[int], size: tuple[int, int] = (192, 256), deep: bool = False
) -> Path:
    """RTMPose's and its kin's; with `deep` depths grow from the left of what it sees to its right."""
    graph, (width, height) = Graph(), size
    column, row, there = _found(graph, "input", size, count, numbers)
    there = graph("Unsqueeze", there, graph.constant([2], np.int64))
    outputs = {"simcc_x": (column, 2 * width), "simcc_y": (row, 2 * height)}
    if deep:
        outputs["simcc_z"] = (column, 2 * width)
    for name, (place, bins) in outputs.items():
        graph("Mul", _bell(graph, graph("Mul", place, 2.0), bins, 6.0), there, name=name)
    shapes = {name: ["batch", f"dim_{name}", bins] for name, (_, bins) in outputs.items()}
    return graph.write(path, {"input": ["batch", 3, height, width]}, shapes)


def heat_maps(
    path: Path, count: int, numbers: Sequence[int], size: tuple[int, int] = (192, 256), unbiased: bool = True
) -> Path:
    """ViTPose's, which is known by its transformer, or HRNet's."""
    graph, (width, height) = Graph(), size
    column, row, there = _found(graph, "input", size, count, numbers)
    steps = [(side - 1) / (side // 4 - 1) if unbiased else 4.0 for side in size]
    across, down = (
        _bell(graph, graph("Div", place, step), side // 4, 2.0)
        for place, step, side in zip((column, row), steps, size, strict=True)
    )
    maps = graph("MatMul", graph("Unsqueeze", down, graph.constant([3], np.int64)),
                 graph("Unsqueeze", across, graph.constant([2], np.int64)))  # fmt: skip
    if unbiased:
        graph("Softmax", maps)
    graph("Mul", maps, graph("Unsqueeze", there, graph.constant([2, 3], np.int64)), name="output")
    return graph.write(
        path, {"input": [1, 3, height, width]}, {"output": [1, count, height // 4, width // 4]}
    )


def instant_hmr(
    path: Path, numbers: Sequence[int], half: bool = False, deep: bool = True, names: bool = True
) -> Path:
    """InstantHMR's, whose points in space lie in a plane that leans away to the right and downward."""
    graph, side = Graph(half), 224
    column, row, _ = _found(graph, "image", (side, side), 70, numbers)
    flat = [
        graph("Unsqueeze", graph("Add", graph("Mul", place, 2.0 / side), 1.0 / side - 1.0),
              graph.constant([2], np.int64))
        for place in (column, row)
    ]  # fmt: skip
    lean = graph("Mul", graph("Add", *flat), 0.25)
    told = graph("Cast", "cliff_cond", to=TensorProto.FLOAT)
    outputs = {
        "mhr_params": graph("MatMul", told, np.ones((3, 204))),
        "shape_params": graph("MatMul", told, np.ones((3, 45))),
        "cam_trans": told,
        "joints_2d": graph("Concat", *flat, axis=2),
    }
    if deep:
        outputs["joints_3d"] = graph("Mul", graph("Concat", *flat, lean, axis=2), 0.5 * METERS)
    sizes = {
        "mhr_params": [204],
        "shape_params": [45],
        "cam_trans": [3],
        "joints_2d": [70, 2],
        "joints_3d": [70, 3],
    }
    shapes = {}
    for name, value in outputs.items():
        own = name if names else f"out_{len(shapes)}"
        graph("Cast", value, to=graph.kind, name=own)
        shapes[own] = ["N", *sizes[name]]
    return graph.write(path, {"image": ["N", 3, side, side], "cliff_cond": ["N", 3]}, shapes)


def draw_dots(size: tuple[int, int], people: Sequence[Array], radius: float = 7.0) -> Image:
    """A picture of dots (N, 2) [px], each in its own color, of several people; those of NaN are left out."""
    fine = 4
    picture = np.zeros((size[1] * fine, size[0] * fine, 3), dtype=np.uint8)
    for points in people:
        for color, place in zip(COLORS, points, strict=False):
            if np.isfinite(place).all():
                at = tuple(round((one * fine - 0.5) * 16) for one in place)
                cv2.circle(
                    picture, at, round(radius * fine * 16), (255 * color[::-1]).round().tolist(), -1, shift=4
                )
    return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)


DOTTED_SIZE = 640, 480
AROUND = {
    **{"nose": ("head", 0.0, -6.0), "neck": ("head", 0.0, 30.0)},
    **{f"{part}.{side}": ("head", sign * x, y) for side, sign in (("L", 1.0), ("R", -1.0))
       for part, x, y in (("eye", 13.0, -14.0), ("ear", 26.0, 0.0))},
    **{f"{part}.{side}": (f"{at}.{side}", sign * x, y) for side, sign in (("L", 1.0), ("R", -1.0))
       for at, part, x, y in (("ankle", "toe", 0.0, 24.0), ("ankle", "small_toe", 14.0, 18.0),
                              ("ankle", "heel", 28.0, 6.0), ("wrist", "thumb", -14.0, 8.0),
                              ("wrist", "index", 0.0, 18.0), ("wrist", "pinky", 14.0, 8.0))},
}  # fmt: skip
"""Of points that are none of the principal ones: which one they lie beside, and where [px]."""


def dotted_clip(file: Path, layout: Layout, frames: int = 24) -> None:
    """Write a clip (.avi) of somebody who moves a little, each point a dot."""
    camera = Camera.from_dict(CAMERA | {"resolution": list(DOTTED_SIZE)})
    pixel, _ = camera.project(BODY.points(BODY.pose(true_postures(frames))))
    at = BODY.skeleton.point_names.index
    video = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"FFV1"), 30.0, DOTTED_SIZE)  # as it is drawn
    for principal in pixel:
        places = (AROUND.get(name, (name, 0.0, 0.0)) for name in layout.names)
        points = np.array([principal[at(beside)] + [x, y] for beside, x, y in places])
        video.write(draw_dots(DOTTED_SIZE, [points], 4.0))
    video.release()


def dotted_performer(take: Path, file: Path, frames: int = 60) -> Path:
    """Write the dim beginning of a take's clip, with COCO's points of its keypoints as bright dots in it."""
    known, clip = read_json(take / "keypoints.json"), Clip.open(take / "clip.mp4")
    video = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"FFV1"), 30.0, clip.size)
    for index, _, picture in islice(clip.frames(), frames):
        place = dict(zip(known["names"], np.array(known["frames"][index])[:, :2], strict=True))
        place |= {f"eye.{side}": 0.5 * (place["nose"] + place[f"ear.{side}"]) for side in "LR"}
        dots = draw_dots(clip.size, [np.array([place[name] for name in LAYOUTS["coco17"].names])], 2.0)
        shown = 0.28 * picture * (1.0 - dots.max(axis=2, keepdims=True) / 255.0) + dots
        video.write(shown.clip(0.0, 255.0).astype(np.uint8))  # too dim for a dot's own color
    video.release()
    return file


class DotNetwork:
    """Keymark's own: it sees the dots about the middle of a crop, in the layout's colors."""

    def __init__(self, layout: Layout) -> None:
        self.names = layout.names

    def __call__(self, picture: Image, crop: Crop) -> Pose:
        """Look at a crop."""
        rows, columns = np.nonzero(picture.max(axis=2) > 200)
        inside = np.abs(np.column_stack([columns, rows]) - crop.center).max(axis=1) < 0.5 * crop.side
        colors, place = picture[rows[inside], columns[inside], ::-1] / 255.0, {}
        whole = True
        for name, color in zip(self.names, COLORS, strict=False):
            own = np.abs(colors - color).max(axis=1) < 0.1
            if own.sum() > 20:
                whole &= bool(np.ptp(columns[inside][own]) < 20)  # no two people
                place[name] = np.array([columns[inside][own].mean(), rows[inside][own].mean()]) + 0.5
        middle = np.mean(list(place.values()), axis=0) if place else crop.center
        pixel = np.array([place.get(name, middle) for name in LAYOUT.names])
        hint = np.column_stack([pixel - middle, np.zeros(len(pixel))]) * METERS / 200.0
        side = CIRCLE * float(np.ptp(pixel, axis=0).max()) / 2.0
        presence = float(whole and len(place) > 0.9 * len(self.names))
        return Pose(pixel, np.full(len(pixel), 0.9), hint, presence, Crop(middle, max(side, 20.0)))

    def each(self, looks: Sequence[tuple[Image, Crop]]) -> list[Pose]:
        """Look at one crop after the other."""
        return [self(*look) for look in looks]


Builder = Callable[[Path], Path]
