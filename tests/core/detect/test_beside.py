"""A network of somebody's own looks at whom Keymark's follows; one that errs throughout is left out."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from _drawn_clip import Drawn
from _networks import METERS, DotNetwork, draw_dots, instant_hmr, simcc
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.detect.closer_look import CloserLook
from keymark.core.detect.families.beside import Beside
from keymark.core.detect.families.instant_hmr import LAYOUT as MHR
from keymark.core.detect.families.table import open_network
from keymark.core.detect.hands import alike
from keymark.core.detect.keypoint_file import read_keypoints, write_keypoints
from keymark.core.detect.keypoints import HAND_NUMBERS, Keypoints, People, SecondSource, mirrored_point
from keymark.core.detect.layouts import LAYOUTS, Layout
from keymark.core.detect.pose_network import LAYOUT, Crop, Look, Pose
from keymark.core.detect.pose_tracking import find_people
from keymark.core.progress import run
from keymark.core.take.reference import seen_reference
from keymark.core.video.clip import Clip

SIZE, FRAMES = (640, 360), 16
COCO = LAYOUTS["coco17"]


def moving(layout: Layout, frame: int, at: tuple[float, float]) -> Array:
    """Places of the points in a frame: each on a way of its own, whose dots do not meet often."""
    numbers = np.arange(len(layout.names))
    off = 13.0 * np.column_stack([np.sin(0.4 * frame + numbers), np.cos(0.3 * frame + 2.0 * numbers)])
    grid = np.column_stack([numbers % 5 - 2, numbers // 5 - 3]) * [38.0, 38.0]
    return grid + off + at


def seen(
    file: Path, layout: Layout, change: Callable[[Beside], None] = lambda _: None
) -> tuple[People, Array]:
    """Two people in a clip as both networks see them, and where they are (F, 2, N, 2)."""
    places = np.array(
        [
            [moving(layout, f, (150.0 + 2.0 * f, 180.0)), moving(layout, f + 9, (490.0, 190.0 - f))]
            for f in range(FRAMES)
        ]
    )
    clip = Clip(
        Path("dots.mp4"), cast(Any, Drawn([draw_dots(SIZE, two, 5.0) for two in places], 15.0, size=SIZE))
    )
    closer = CloserLook(open_network(file))
    assert closer.beside is not None
    change(closer.beside)
    return run(find_people(clip, cast(Any, DotNetwork(layout)), closer)), places


def test_two_people_are_seen_by_both_and_kept_in_a_file(tmp_path: Path) -> None:
    file = instant_hmr(tmp_path / "body.onnx", MHR.numbers)
    people, places = seen(file, MHR)
    assert people.second is not None and people.second.motion
    assert people.second.detector == "InstantHMR, 70 points, 224 x 224" and len(people.second.digest) == 64
    first = len(LAYOUT.names)
    assert people.names[first:] == MHR.names
    assert people.sources == ("BlazePose",) * first + (people.second.detector,) * len(MHR.names)
    for frame, true in zip(people.frames, places, strict=True):
        order = np.argsort(frame.pixel[:, 0, 0])
        np.testing.assert_allclose(frame.pixel[order, first:], true, atol=0.15)
        assert np.isfinite(frame.hint_m[:, first:]).all()
    kept = tmp_path / "keypoints.json"
    write_keypoints(kept, people, 1, 15.0)
    file.unlink()
    back = read_keypoints(kept, FRAMES, SIZE, 15.0)
    assert (back.names, back.sources, back.second) == (people.names, people.sources, people.second)
    for frame, other in zip(back.frames, people.frames, strict=True):
        np.testing.assert_allclose(frame.pixel, other.pixel, atol=1e-3)
        np.testing.assert_allclose(frame.hint_m, other.hint_m, atol=1e-4)


def test_depths_become_hints_in_the_size_that_the_own_network_guesses(tmp_path: Path) -> None:
    people, places = seen(
        simcc(tmp_path / "deep.onnx", 133, LAYOUTS["wholebody133"].numbers[:17], deep=True), COCO
    )
    first, hips = len(LAYOUT.names), [COCO.names.index(f"hip.{side}") for side in "LR"]
    frame, true = people.frames[3], places[3, 0] - places[3, 0][hips].mean(axis=0)
    row = int(np.argmin(frame.pixel[:, 0, 0]))
    hint = frame.hint_m[row, first : first + 17]
    np.testing.assert_allclose(hint[:, :2], true * METERS / 200.0, atol=0.01)
    assert np.corrcoef(hint[:, 2], true[:, 0])[0, 1] > 0.999 and not cast(Any, people.second).motion


def rewired(look: Callable[[Look, int], Look]) -> Callable[[Beside], None]:
    """A change of what a network says, by the number of the look."""

    def change(beside: Beside) -> None:
        each, count = beside.network.each, iter(range(10**6))
        cast(Any, beside.network).each = lambda looks: [look(one, next(count)) for one in each(looks)]

    return change


def test_a_network_that_errs_throughout_is_left_out_with_a_sentence(tmp_path: Path) -> None:
    file = simcc(tmp_path / "net.onnx", 17, COCO.numbers)
    other = [COCO.names.index(mirrored_point(name)) for name in COCO.names]
    first, said = list[Look](), list[Look]()

    def constant(look: Look, number: int) -> Look:
        first.append(look)
        return Look(look.pixel.mean(axis=0) + first[0].pixel - first[0].pixel.mean(axis=0), look.score)

    def late(look: Look, number: int) -> Look:
        said.append(look)
        early = said[max(number - 15, 0)].pixel
        return Look(early - early.mean(axis=0) + look.pixel.mean(axis=0), look.score)

    wrong = {
        "has left for right": lambda look, _: Look(look.pixel[other], look.score),
        "is not where the performer is seen": lambda look, _: Look(
            look.pixel[other] + [90.0, 0.0], look.score
        ),
        "says about the same whatever it sees": constant,
        "about the same": late,
    }
    plain, _ = seen(file, COCO)
    assert plain.second is not None and not plain.notes
    for sentence, change in wrong.items():
        people, _ = seen(file, COCO, rewired(change))
        assert people.second is None and people.names == LAYOUT.names
        assert len(people.notes) == 1 and sentence in people.notes[0]
        np.testing.assert_array_equal(people.frames[5].pixel, plain.frames[5].pixel[:, : len(LAYOUT.names)])


def test_hands_that_keymarks_own_network_has_not_seen_are_the_others(tmp_path: Path) -> None:
    beside = Beside(open_network(simcc(tmp_path / "net.onnx", 17, COCO.numbers)))
    own, other = np.full((2, HAND_NUMBERS), np.nan), np.tile([1.0, 2.0, *np.tile(np.arange(10.0), 2)], (2, 1))
    own[0] = np.arange(HAND_NUMBERS)
    hint = np.random.default_rng(1).normal(size=(len(LAYOUT.names), 3)) * 0.3
    for size_px, wanted in ((400.0, [own[0], other[1]]), (100.0, own)):
        pose = Pose(
            size_px * hint[:, :2], np.ones(len(hint)), hint, 0.9, Crop(np.zeros(2), size_px), hands=own
        )
        joined = beside._joined(pose, Look(np.zeros((17, 2)), np.ones(17), hands=other))
        np.testing.assert_array_equal(joined.hands, wanted)
        assert alike(joined.hands).tolist() == [False, size_px > 200.0]


def test_single_looks_at_somebody_else_are_left_out(tmp_path: Path) -> None:
    file = simcc(tmp_path / "net.onnx", 17, COCO.numbers)
    people, _ = seen(
        file, COCO, rewired(lambda look, number: Look(look.pixel + 90.0 * (number % 4 == 1), look.score))
    )
    also = np.concatenate([frame.score[:, len(LAYOUT.names) :] for frame in people.frames])
    assert people.second is not None and (also.max(axis=1) == 0.0).sum() == len(also) // 4


@pytest.mark.parametrize(("points", "sentence"), [(40, "second: names"), (1, "frames.0. is")])
def test_a_file_whose_second_source_has_no_points_of_its_own(
    points: int, sentence: str, tmp_path: Path
) -> None:
    from keymark.core.errors import InputError
    from keymark.core.files.json_file import write_json

    file = tmp_path / "keypoints.json"
    rows = {"layout": "own", "names": ["nose", "neck"], "size": [64, 48], "frames": [[[5, 5, 1], [6, 6, 1]]]}
    write_json(file, rows | {"second": {"detector": "x", "names": ["nose"] * points}})
    with pytest.raises(InputError, match=sentence):
        read_keypoints(file, 1, (64, 48))


def test_what_is_seen_in_space_is_a_motion_with_z_up_and_no_hint() -> None:
    names, hint = (*LAYOUT.names, *MHR.names), np.zeros((3, len(LAYOUT.names) + len(MHR.names), 3))
    hint[:] = np.random.default_rng(6).normal(size=hint.shape)
    second = SecondSource("InstantHMR", MHR.names, motion=True)
    people = People(names, "BlazePose", SIZE, (), second=second)
    flat = np.ones((3, len(names), 2))
    found, left = seen_reference(Keypoints(names, people.sources, flat, flat[..., 0], hint), [people])
    assert found is not None and found.name == "InstantHMR"
    first, knee = len(LAYOUT.names), MHR.names.index("knee.L")
    right, down, away = np.moveaxis(hint[:, first + knee], -1, 0)
    own = found.points_m[:, HUMAN.point_names.index("knee.L")]
    np.testing.assert_allclose(own, np.stack([right, away, -down], axis=-1))
    assert np.isnan(left.hint_m[:, first:]).all() and (left.hint_m[:, :first] == hint[:, :first]).all()
