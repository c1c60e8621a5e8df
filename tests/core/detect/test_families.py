"""Networks that people bring: each family's convention, by networks that find dots; what is refused."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import onnx
import pytest
from _networks import METERS, Builder, draw_dots, heat_maps, instant_hmr, simcc
from keymark.core.arrays import Array
from keymark.core.body.fingers import RESTING, finger_bones, palm_of
from keymark.core.body.rotations import exponential, hinge
from keymark.core.detect.families.beside import Beside
from keymark.core.detect.families.instant_hmr import FROM_WRIST, LEFT
from keymark.core.detect.families.instant_hmr import LAYOUT as MHR
from keymark.core.detect.families.network import Box, Window
from keymark.core.detect.families.table import open_network
from keymark.core.detect.hands import alike
from keymark.core.detect.keypoints import FACING, HAND_NUMBERS
from keymark.core.detect.layouts import LAYOUTS
from keymark.core.detect.onnx_file import LARGEST_BYTES, read_onnx
from keymark.core.detect.pose_network import LAYOUT as OWN
from keymark.core.detect.pose_network import Crop, Look, Pose
from keymark.core.errors import InputError
from onnx import TensorProto, helper, numpy_helper

SIZE = (480, 360)
COCO, HALPE, WHOLE = LAYOUTS["coco17"], LAYOUTS["halpe26"], LAYOUTS["wholebody133"]
BUILDERS: dict[str, Builder] = {
    "RTMPose, 17 points, 256 x 192": partial(simcc, count=17, numbers=COCO.numbers),
    "RTMPose, 26 points, 384 x 288": partial(simcc, count=26, numbers=HALPE.numbers, size=(288, 384)),
    "RTMW, 133 points, 384 x 288": partial(simcc, count=133, numbers=WHOLE.numbers[:29], size=(288, 384)),
    "RTMW3D, 133 points, 384 x 288": partial(
        simcc, count=133, numbers=WHOLE.numbers[:29], size=(288, 384), deep=True
    ),
    "ViTPose, 17 points, 256 x 192": partial(heat_maps, count=17, numbers=COCO.numbers),
    "HRNet, 17 points, 384 x 288": partial(
        heat_maps, count=17, numbers=COCO.numbers, size=(288, 384), unbiased=False
    ),
    "InstantHMR, 70 points, 224 x 224": partial(instant_hmr, numbers=MHR.numbers),
}


def dots(count: int, width: float, height: float, seed: int = 2) -> Array:
    """(N, 2) places at least 17 px from each other, about (0, 0)."""
    rng, found = np.random.default_rng(seed), list[Array]()
    while len(found) < count:
        place = rng.uniform(-0.5, 0.5, 2) * (width, height)
        if all(np.hypot(*(place - other)) > 17.0 for other in found):
            found.append(place)
    return np.array(found)


def seen(file: Path, *people: Array) -> list[Look]:
    """Whom a network sees in a picture of people, each in the box about them."""
    network, picture = open_network(file), draw_dots(SIZE, people)
    return network.each([(picture, Box.about(points)) for points in people])


@pytest.mark.parametrize("name", BUILDERS)
def test_a_network_is_known_and_its_points_lie_where_they_are(name: str, tmp_path: Path) -> None:
    file = BUILDERS[name](tmp_path / "any.onnx")
    network = open_network(file)
    assert network.name == name and len(network.file.digest) == 64
    count = len(network.layout.numbers)
    upright, lying = dots(min(count, 29), 110.0, 190.0), dots(min(count, 29), 190.0, 110.0, seed=5)
    turned = lying[:, ::-1] * [-1.0, 1.0]
    for place, points in (((245.3, 180.8), upright), ((210.0, 90.4), lying), ((250.7, 170.0), turned)):
        (look,) = seen(file, points + place)
        np.testing.assert_allclose(look.pixel[: len(points)], points + place, atol=0.1)
        assert look.score is None or (look.score[: len(points)] > 0.5).all()


@pytest.mark.parametrize("name", BUILDERS)
def test_two_people_and_one_who_leaves_the_picture(name: str, tmp_path: Path) -> None:
    file = BUILDERS[name](tmp_path / "any.onnx")
    points = dots(17, 100.0, 170.0)
    left, right = points + (90.2, 170.5), points[:, ::-1] * [0.9, 1.0] + (380.8, 150.4)
    for look, people in zip(seen(file, left, right), (left, right), strict=True):
        np.testing.assert_allclose(look.pixel[:17], people, atol=0.1)
    leaving = points + (15.0, 330.0)
    inside = ((leaving > 8.0) & (leaving < np.array(SIZE) - 7.0)).all(axis=1)
    outside = ((leaving < -8.0) | (leaving > np.array(SIZE) + 7.0)).any(axis=1)
    (look,) = seen(file, leaving)
    assert inside.sum() >= 5 and outside.sum() >= 5
    np.testing.assert_allclose(look.pixel[:17][inside], leaving[inside], atol=0.1)
    assert look.score is None or (look.score[:17][outside] < 0.05).all()


@pytest.mark.parametrize("changes", [{}, {"half": True}, {"names": False}])
def test_points_in_space_are_right_down_and_away_about_the_hips(
    changes: dict[str, bool], tmp_path: Path
) -> None:
    file = instant_hmr(tmp_path / "body.onnx", MHR.numbers, **changes)
    points = dots(29, 110.0, 190.0) + (240.0, 180.0)
    (look,), network = seen(file, points), open_network(file)
    box = Box.about(points)
    at = 2.0 * (points - box.center) / (1.2 * box.size.max())
    lean = 0.25 * at.sum(axis=1, keepdims=True)
    expected = 0.5 * METERS * np.concatenate([at, lean], axis=1)
    hips = [MHR.names.index("hip.L"), MHR.names.index("hip.R")]
    expected -= expected[hips].mean(axis=0)
    assert network.motion and look.hint_m is not None
    assert look.hands is not None and look.hands.shape == (2, HAND_NUMBERS) and alike(look.hands).all()
    np.testing.assert_allclose(look.hint_m[:29], expected, atol=0.003 if changes.get("half") else 0.001)


HAND_TURN = exponential(np.array([0.2, -0.5, 0.4]))


def bent_hand(side: str) -> Array:
    """(21, 3) points of a hand, its joints bent by .4 rad, before it is turned [m]."""
    points = [np.zeros(3)]
    for name, start, end, axis in finger_bones(side):
        if ".1." in name:
            bend, at = np.eye(3), start
            points.append(at)
        bend = bend @ hinge(axis, np.array(0.4))
        at = at + bend @ (end - start)
        points.append(at)
    return 0.15 * np.array(points)


def assert_bent(hand: Array, side: str, within: float) -> None:
    own = palm_of(bent_hand(side), side) @ RESTING[side].T
    wanted = HAND_TURN @ FACING @ own @ FACING.T
    np.testing.assert_allclose(exponential(hand[2:5]), wanted, atol=within)
    np.testing.assert_allclose(hand[7:12], 0.4, atol=0.05)


@pytest.mark.parametrize("side", ["L", "R"])
def test_points_of_hands_in_space_are_hands(side: str, tmp_path: Path) -> None:
    network = open_network(instant_hmr(tmp_path / "body.onnx", MHR.numbers))
    flat, space, first = np.zeros((1, 70, 2)), np.zeros((1, 70, 3)), LEFT if side == "L" else 21
    space[0, first + FROM_WRIST] = bent_hand(side) @ (HAND_TURN @ FACING).T
    flat[0, first + FROM_WRIST[0]] = 0.5, 0.0
    outputs = [np.zeros(1)] * 5
    outputs[network._flat], outputs[network._deep] = flat, space
    hands = network.read(outputs, Window(np.zeros(2), 1.0)).hands
    hand = hands["LR".index(side)]
    np.testing.assert_allclose(hand[:2], (168.0, 112.0))
    assert_bent(hand, side, 1e-6)


@pytest.mark.parametrize("side", ["L", "R"])
def test_whole_bodies_with_depths_have_hands_where_these_are_seen(side: str, tmp_path: Path) -> None:
    network = open_network(simcc(tmp_path / "deep.onnx", 133, WHOLE.numbers[:29], deep=True))
    first, per_m = 91 if side == "L" else 112, 300.0
    place, sure = np.zeros((133, 3)), np.where(np.arange(133) < 17, 0.8, 0.1)
    place[first : first + 21] = bent_hand(side) @ (HAND_TURN @ FACING).T
    sure[first : first + 21] = 0.7
    columns = [
        2.0 * (96.0 + per_m * place[:, 0]),
        2.0 * (128.0 + per_m * place[:, 1]),
        (place[:, 2] / 2.1744869 + 1.0) * 288.0,
    ]
    outputs = [
        (sure[:, None] * np.exp(-((np.arange(bins) - at[:, None]) ** 2) / 8.0))[None]
        for at, bins in zip(columns, (384, 512, 576), strict=True)
    ]
    hint = np.random.default_rng(3).normal(size=(len(OWN.names), 3)) * 0.3
    crop = Crop(np.zeros(2), 300.0)
    pose = Pose(per_m * hint[:, :2], np.ones(len(hint)), hint, 0.9, crop)
    hands = Beside(network)._joined(pose, network.read(outputs, Window(np.zeros(2), 1.0))).hands
    assert np.isnan(hands["RL".index(side)]).all()
    hand = hands["LR".index(side)]
    np.testing.assert_allclose(hand[:2], (96.5, 128.5), atol=0.1)
    assert_bent(hand, side, 0.02)


def test_a_body_network_is_told_where_the_box_is(tmp_path: Path) -> None:
    file = instant_hmr(tmp_path / "body.onnx", MHR.numbers, deep=False)
    network, picture = open_network(file), draw_dots(SIZE, [])
    assert not network.motion
    box = Box(np.array([360.0, 90.0]), np.array([96.0, 120.0]))
    _, (_, told) = network.prepare(picture, box)
    np.testing.assert_allclose(told, [[0.5, -0.5, 0.25]], atol=1e-6)
    model = onnx.load(file)
    model.metadata_props.add(key="cliff_focal", value="true")
    onnx.save(model, file)
    _, (_, told) = open_network(file).prepare(picture, box)
    focal = 1.05 * 600.0
    np.testing.assert_allclose(
        told, [[np.arctan(120 / focal), np.arctan(-90 / focal), 120 / focal]], atol=1e-6
    )


def test_depths_are_meters_away_from_the_camera(tmp_path: Path) -> None:
    file = simcc(tmp_path / "deep.onnx", 133, WHOLE.numbers[:29], deep=True)
    points = dots(29, 110.0, 190.0) + (240.0, 180.0)
    (look,), box = seen(file, points), Box.about(points)
    width = 1.25 * max(box.size[0] / 192, box.size[1] / 256) * 192
    column = (points[:, 0] - box.center[0]) / width + 0.5 - 0.5 / 192
    assert look.depth_m is not None
    np.testing.assert_allclose(look.depth_m[:29], (2.0 * column - 1.0) * 2.1744869, atol=0.003)


# --- Files that are refused


def changed(file: Path, change: Callable[[onnx.ModelProto], object]) -> Path:
    """The file with a change of its model."""
    model = onnx.load(file)
    change(model)
    file.write_bytes(model.SerializeToString())
    return file


def resized(part: str, axis: int, length: int | str) -> Callable[[onnx.ModelProto], None]:
    def change(model: onnx.ModelProto) -> None:
        dim = getattr(model.graph, part)[0].type.tensor_type.shape.dim[axis]
        dim.Clear()
        setattr(dim, "dim_param" if isinstance(length, str) else "dim_value", length)

    return change


def of_type(kind: int) -> Callable[[onnx.ModelProto], None]:
    def change(model: onnx.ModelProto) -> None:
        model.graph.input[0].type.tensor_type.elem_type = kind

    return change


def external(model: onnx.ModelProto) -> None:
    model.graph.initializer[0].data_location = TensorProto.EXTERNAL
    model.graph.initializer[0].external_data.add(key="location", value="/etc/passwd")


def external_in_a_node(model: onnx.ModelProto) -> None:
    value = numpy_helper.from_array(np.zeros(3, dtype=np.float32))
    value.external_data.add(key="location", value="weights.bin")
    model.graph.node.append(helper.make_node("Constant", [], ["unused"], value=value))


def custom(model: onnx.ModelProto) -> None:
    branch = helper.make_graph([helper.make_node("Run", [], ["b"], domain="my.lab")], "b", [], [])
    model.graph.node.append(helper.make_node("If", ["input"], ["c"], then_branch=branch, else_branch=branch))


def constant_of(shape: list[int]) -> Callable[[onnx.ModelProto], None]:
    return lambda model: model.graph.initializer.append(TensorProto(dims=shape, data_type=1, name="large"))


def not_a_number(model: onnx.ModelProto) -> None:
    spread = numpy_helper.from_array(np.array(np.nan, dtype=np.float32), model.graph.initializer[1].name)
    model.graph.initializer[1].CopyFrom(spread)


def lacking(model: onnx.ModelProto) -> None:
    del model.graph.node[3]


WRONG = {
    "operators of its own": (custom, "uses the operator 'Run' of 'my.lab'"),
    "functions": (
        lambda model: model.functions.add(name="f", domain="my.lab"),
        "brings functions of its own",
    ),
    "external data": (external, "has its weights in another file"),
    "external data of a node": (external_in_a_node, "has its weights in another file"),
    "a huge constant": (constant_of([2**20, 2**20]), "a damaged one"),
    "a negative constant": (constant_of([-4]), "a damaged one"),
    "a huge picture": (resized("input", 2, 100_000), "takes input .any, 3, 100000, 192."),
    "an open height": (resized("input", 2, "height"), "takes input .any, 3, any, 192."),
    "a negative width": (resized("input", 3, -5), "takes input .any, 3, 256, any."),
    "eight pictures": (resized("input", 0, 8), "takes input .8, 3, 256, 192."),
    "whole numbers": (of_type(TensorProto.INT64), "of type 7"),
    "no tensor": (lambda model: model.graph.input[0].type.Clear(), "takes input"),
    "not a number": (not_a_number, "no numbers"),
    "another width": (resized("input", 3, 64), "(cannot be|as no known network does)"),
    "an operator too few": (lacking, "cannot be opened as a network"),
    "no output": (lambda model: model.graph.ClearField("output"), "must have operators, inputs and outputs"),
    "no graph": (lambda model: model.ClearField("graph"), "it has 0 graphs"),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_network_that_could_do_more_or_less_is_refused_in_a_sentence(what: str, tmp_path: Path) -> None:
    change, sentence = WRONG[what]
    file = changed(simcc(tmp_path / "net.onnx", 17, COCO.numbers), change)
    with pytest.raises(InputError, match=sentence) as caught:
        open_network(file)
    assert str(caught.value).startswith(str(file)) and "\n" not in str(caught.value)


def test_a_network_of_another_kind_is_told_what_is_known(tmp_path: Path) -> None:
    for file in (simcc(tmp_path / "hand.onnx", 21, [0, 5]), heat_maps(tmp_path / "animal.onnx", 20, [0, 5])):
        with pytest.raises(InputError, match="as no known network does; known are InstantHMR .*ViTPose"):
            open_network(file)


def test_what_is_no_onnx_file(tmp_path: Path) -> None:
    file = tmp_path / "net.onnx"
    for content, sentence in (
        (b"PK\x03\x04rest", "is a zip archive; unpack it"),
        (b"", "it has 0 graphs"),
        (b"<html>not found</html>", "no ONNX file, or a damaged one"),
        (b"\x3a\xff\xff\xff\xff\x0f", "ends within a field"),
    ):
        file.write_bytes(content)
        with pytest.raises(InputError, match=sentence):
            open_network(file)
    with pytest.raises(InputError, match="no such file"):
        open_network(tmp_path / "none.onnx")
    with file.open("wb") as large:
        large.truncate(LARGEST_BYTES + 1)
    with pytest.raises(InputError, match="a network may have 512"):
        open_network(file)


@pytest.mark.fuzz
def test_damaged_files_are_one_sentence(tmp_path: Path) -> None:
    whole = simcc(tmp_path / "net.onnx", 17, COCO.numbers).read_bytes()
    rng, file, refused = np.random.default_rng(4), tmp_path / "damaged.onnx", 0
    for number in range(150):
        damaged = bytearray(whole)
        if number % 3 == 0:
            del damaged[rng.integers(len(damaged)) :]
        elif number % 3 == 1:  # its first half has the operators
            damaged[rng.integers(len(damaged) // 2)] = rng.integers(256)
        else:
            at = rng.integers(len(damaged) - 8)
            damaged[at : at + 8] = rng.bytes(8)
        file.write_bytes(damaged)
        try:
            read_onnx(file)
        except InputError as error:
            assert "\n" not in str(error) and len(str(error)) < 500
            refused += 1
    assert refused >= 50  # at least all that end early
