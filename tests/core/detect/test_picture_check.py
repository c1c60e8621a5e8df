"""A file of keypoints is held against the pictures: what it is of, and what it is not."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from _drawn_clip import SHAPE, Drawn, FakeNetwork, MiddleNetwork, draw_people
from keymark.core.arrays import Array
from keymark.core.body.rotations import exponential, logarithm
from keymark.core.detect.hands import hand_of
from keymark.core.detect.keypoints import People, SeenPeople, mirrored_point, no_hands
from keymark.core.detect.picture_check import PictureFinding, applied, check_by_pictures
from keymark.core.detect.pose_network import LAYOUT, NAME
from keymark.core.errors import InputError
from keymark.core.progress import run
from keymark.core.video.album import GLIMPSES, Album, Glimpses, WatchedClip
from keymark.core.video.clip import Clip
from keymark.core.video.frame_checks import FrameChecks

SIZE, FRAMES, FPS = (320, 240), 60, 30.0
RADIUS = 50.0
CENTER = np.stack([60.0 + 3.0 * np.arange(FRAMES), 120.0 + 20.0 * np.sin(0.2 * np.arange(FRAMES))], axis=-1)
SWAPPED = [LAYOUT.names.index(mirrored_point(name)) for name in LAYOUT.names]


@pytest.fixture(scope="module")
def glimpses() -> Glimpses:
    """Pictures of one person who walks across."""
    pictures = [draw_people(SIZE, [(x, y, RADIUS)]) for x, y in CENTER]
    return seen_of(pictures)


def seen_of(pictures: list[np.ndarray]) -> Glimpses:
    size = (pictures[0].shape[1], pictures[0].shape[0])
    drawn = cast(Any, Drawn(pictures, size=size))
    kept = Glimpses.of(Clip(Path("drawn.mp4"), drawn))
    for _ in WatchedClip(Path(), drawn, checks=FrameChecks(), album=Album(), glimpses=kept).frames():
        pass
    return kept


def people(change: Callable[[Array], Array] = np.asarray, frames: Array | None = None) -> People:
    """The same person, as a file may have him."""
    pixel = CENTER[:, None] + RADIUS * SHAPE
    rows = pixel if frames is None else pixel[np.clip(frames, 0, FRAMES - 1)]
    score, hint = np.full((1, len(SHAPE)), 0.9), np.zeros((1, len(SHAPE), 3))
    return People(
        LAYOUT.names,
        "detector",
        SIZE,
        tuple(SeenPeople(change(row)[None], score, hint) for row in rows),
        "there/seen.json",
    )


def finding(of: People, glimpses: Glimpses, network: FakeNetwork | None = None) -> PictureFinding:
    return run(check_by_pictures(of, glimpses, cast(Any, network or FakeNetwork()), FPS))


def test_a_file_of_this_clip_stays_as_it_is(glimpses: Glimpses) -> None:
    network = FakeNetwork()
    own = people(lambda row: row + 1.5)
    found = finding(own, glimpses, network)
    assert found == PictureFinding(looked=dict.fromkeys(glimpses.frames, True))
    assert network.looks == GLIMPSES
    same = applied(own, found)
    assert tuple(same.in_pictures) == tuple(glimpses.frames)
    for frame, shown in same.in_pictures.items():
        np.testing.assert_allclose(shown, people().frames[frame].pixel[0], atol=2.0)
    assert not finding(replace(own, source=NAME), glimpses).seen  # of itself it knows more than a picture
    assert same.frames == own.frames and not same.notes


@pytest.mark.parametrize(("scale", "size"), [(0.5, "160 x 120"), (0.75, "240 x 180"), (1.25, "400 x 300")])
def test_another_size_is_used_and_said(glimpses: Glimpses, scale: float, size: str) -> None:
    found = finding(people(lambda row: scale * row), glimpses)
    assert found.scale == pytest.approx((1.0 / scale, 1.0 / scale)) and not found.mirrored
    mended = applied(people(lambda row: scale * row), found)
    np.testing.assert_allclose(mended.frames[7].pixel, people().frames[7].pixel)
    (note,) = mended.notes
    assert note.startswith("detector: ") and size in note


def test_a_squeezed_copy_is_scaled_along_both_axes(glimpses: Glimpses) -> None:
    found = finding(people(lambda row: row * [0.8, 1.0]), glimpses)
    assert found.scale == pytest.approx((1.25, 1.0))


def test_a_mirrored_copy_is_turned_back(glimpses: Glimpses) -> None:
    flipped = people(lambda row: (np.array([SIZE[0], 0.0]) + row * [-1.0, 1.0])[SWAPPED])
    found = finding(flipped, glimpses)
    assert found.mirrored and found.scale == (1.0, 1.0)
    mended = applied(flipped, found)
    own = [mended.names.index(name) for name in LAYOUT.names]
    np.testing.assert_allclose(mended.frames[7].pixel[0, own], people().frames[7].pixel[0])
    assert "mirrored" in mended.notes[0]


@pytest.mark.parametrize(
    ("late", "words"),
    [
        (9, "about 9 frames before: it is late"),
        *((late, "it is late") for late in (2, 3, 5)),
        (1, "about 1 frame before: it is late"),
        (-1, "about 1 frame after: it is early"),
        (-2, "it is early"),
        (-9, "about 9 frames after: it is early"),
    ],
)
def test_another_time_is_shifted_back(glimpses: Glimpses, late: int, words: str) -> None:
    shifted = people(frames=np.arange(FRAMES) - late)
    mended = applied(shifted, finding(shifted, glimpses))
    assert words in mended.notes[0] and len(mended.frames) == FRAMES
    inside = range(max(-late, 0), FRAMES - max(late, 0))
    for index in inside:
        np.testing.assert_array_equal(mended.frames[index].pixel, shifted.frames[index + late].pixel)
    silent = tuple(index for index in range(FRAMES) if index not in inside)
    assert mended.silent == silent and not any(len(mended.frames[index].pixel) for index in silent)


@pytest.mark.parametrize("side", ["L", "R"])
def test_faces_and_hands_change_sides_with_a_mirrored_copy(side: str) -> None:
    rng, middle = np.random.default_rng(7), np.array([200.0, 90.0])
    points, flip = rng.normal(size=(21, 3)), np.array([-1.0, 1.0, 1.0])
    turn = exponential(np.array([0.3, -0.5, 0.2]))
    hands, row = no_hands()[None], "LR".index(side)
    hands[0, row] = hand_of(points, middle, side)
    hands[0, row, 5] = 0.4  # presence in the first look, which is the second one of a mirrored picture
    face = np.array([[*middle, *logarithm(turn), 0.9]])
    frames = tuple(replace(frame, face=face, hands=hands) for frame in people().frames)
    mended = applied(replace(people(), frames=frames), PictureFinding(mirrored=True)).frames[5]
    place = [SIZE[0] - middle[0], middle[1]]
    turned = logarithm(np.outer(flip, flip) * turn)
    np.testing.assert_allclose(mended.face[0], [*place, *turned, 0.9], atol=1e-12)
    expected = hand_of(points * flip, np.array(place), "RL"[row])
    expected[15] = 0.4
    np.testing.assert_allclose(mended.hands[0, 1 - row], expected, atol=1e-9)
    assert np.isnan(mended.hands[0, row]).all()


def test_faces_and_hands_go_along_with_what_is_scaled_and_shifted() -> None:
    face, hands = np.arange(6.0)[None], np.arange(44.0).reshape(1, 2, 22)
    frames = tuple(
        replace(frame, face=face + index, hands=hands) for index, frame in enumerate(people().frames)
    )
    mended = applied(replace(people(), frames=frames), PictureFinding((2.0, 3.0), shift=4)).frames[5]
    np.testing.assert_array_equal(mended.face, (face + 9) * [2.0, 3.0, 1.0, 1.0, 1.0, 1.0])
    np.testing.assert_array_equal(mended.hands[..., :2], hands[..., :2] * [2.0, 3.0])
    np.testing.assert_array_equal(mended.hands[..., 2:], hands[..., 2:])


def test_another_rate_is_refused(glimpses: Glimpses) -> None:
    slow = people(frames=np.arange(FRAMES) // 2)
    with pytest.raises(InputError, match=r"there/seen.json: it runs through the motion 0.5 times as fast"):
        applied(slow, finding(slow, glimpses))


def test_another_clip_is_refused(glimpses: Glimpses) -> None:
    rng = np.random.default_rng(4)
    other = people()
    frames = tuple(
        SeenPeople(rng.uniform([0.0, 0.0], SIZE, frame.pixel.shape), frame.score, frame.hint_m)
        for frame in other.frames
    )
    with pytest.raises(InputError, match=r"seen\.json: nobody in it is where a person is seen"):
        applied(other, finding(replace(other, frames=frames), glimpses))


def test_what_the_pictures_do_not_tell_is_not_said(glimpses: Glimpses) -> None:
    wrong = people(lambda row: 0.5 * row)
    blind = MiddleNetwork()
    blind.presence = 0.0
    assert finding(wrong, glimpses, blind) == PictureFinding()
    empty = seen_of(
        [draw_people(SIZE, []) + 40 * (np.arange(SIZE[0]) % 2).astype(np.uint8)[:, None]] * FRAMES
    )
    assert finding(wrong, empty) == PictureFinding()
    few = replace(wrong, frames=wrong.frames[:2])
    assert finding(few, glimpses) == PictureFinding()


def test_frames_with_somebody_else_are_named(glimpses: Glimpses) -> None:
    own = people()
    away = set(range(20, 40))
    frames = tuple(
        SeenPeople(frame.pixel + [0.0, 400.0], frame.score, frame.hint_m) if index in away else frame
        for index, frame in enumerate(own.frames)
    )
    found = finding(replace(own, frames=frames), glimpses)
    assert found.looked == {frame: frame not in away for frame in glimpses.frames} and not found.refusal
    assert applied(own, found).looked == found.looked


def test_glimpses_are_kept_with_a_reading(glimpses: Glimpses) -> None:
    again = Glimpses.from_arrays(glimpses.to_arrays())
    assert again.frames == glimpses.frames and len(again.frames) == GLIMPSES
    picture, factor = again.picture(again.frames[3])
    assert picture.shape == (240, 320, 3) and factor == 1.0
    large = seen_of([draw_people((1280, 720), [(600.0 + x, 300.0, 90.0)]) for x in range(12)])
    picture, factor = large.picture(large.frames[0])
    assert picture.shape == (360, 640, 3) and factor == 2.0
