"""The performer's keypoints of a take: who says which of several people it is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.arrays import Array
from keymark.core.body.mirror import other_side
from keymark.core.detect.keypoints import Keypoints, People, SecondSource, SeenPeople
from keymark.core.errors import InputError
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Matched, interpolate
from keymark.core.take.performer_keypoints import people_of, performer_keypoints
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 30
SHIFT = np.array([45.0, 4.0])
"""Where the twin stands, from the performer [px]."""


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("takes") / "take", FRAMES, 4))


def performer_pixels(take: Take) -> Array:
    """(F, 13, 2) the performer's joints in the picture."""
    posture = interpolate(take.keyframes, FRAMES)
    pixel, _ = take.camera.project(take.body.points(take.body.pose(posture)), np.arange(FRAMES)[:, None])
    return pixel


def two_people(take: Take, by_hand: bool = False) -> tuple[People, list[int]]:
    """The performer and a twin beside in an order that changes; the performer's index a frame."""
    generator = np.random.default_rng(6)
    pixel = performer_pixels(take)
    frames, truth = [], []
    for index in range(FRAMES):
        both = np.stack([pixel[index], pixel[index] + SHIFT]) + generator.normal(scale=0.3, size=(2, 13, 2))
        order = generator.permutation(2)
        frames.append(SeenPeople(both[order], np.full((2, 13), 0.8), np.full((2, 13, 3), np.nan)))
        truth.append(int(np.flatnonzero(order == 0)[0]))
    names = take.body.skeleton.point_names
    return People(names, "detector", take.camera.resolution, tuple(frames), by_hand=by_hand), truth


def assert_shows(found: Keypoints, people: People, truth: list[int]) -> None:
    for index, (frame, row) in enumerate(zip(people.frames, truth, strict=True)):
        np.testing.assert_array_equal(found.pixel[index], frame.pixel[row])


def test_keyframes_say_who_the_performer_is(take: Take) -> None:
    people, truth = two_people(take)
    found = performer_keypoints(replace(take, keypoints=(people,)))
    assert_shows(found, people, truth)
    (note,) = found.notes
    assert note == (
        f"detector: up to 2 people in {FRAMES} frames, copies of each other, of whom the one on the left is "
        "taken; the performer is the one that the keyframes show"
    )


@pytest.mark.parametrize("guessed", [False, True])
def test_a_network_beside_another_is_told_from_one_that_guesses_depths(take: Take, guessed: bool) -> None:
    people, _ = two_people(take)
    second = replace(people, second=SecondSource("another", people.names[3:]))
    if guessed:
        hints = [np.where(np.arange(13)[:, None] < 12, np.nan, 0.1) * np.ones((2, 13, 3))] * FRAMES
        pairs = zip(second.frames, hints, strict=True)
        second = replace(second, frames=tuple(replace(one, hint_m=hint) for one, hint in pairs))
    found = performer_keypoints(replace(take, keypoints=(second,)))
    assert found.sources == ("detector",) * 3 + ("another",) * 10
    assert found.beside == ({} if guessed else {"another": "detector"})
    joined = Keypoints.side_by_side([Keypoints.none(FRAMES), found], FRAMES)
    assert joined.beside == found.beside


def test_keyframes_count_in_their_own_frames_before_there_is_a_prior(take: Take) -> None:
    people, truth = two_people(take)
    one = replace(take, keyframes=take.keyframes[1:2], keypoints=(people,))
    found = performer_keypoints(one)
    assert_shows(found, people, truth)
    assert "the keyframes show" in found.notes[0]
    matched = replace(one.keyframes[0], matched=Matched("walking", "Left foot lands", False, 0.9))
    assert "click on another" in performer_keypoints(replace(one, keyframes=(matched,))).notes[0]


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("number", [1, 2])
def test_the_performer_is_named_from_the_left_and_copies_are_said(
    take: Take, number: int, mirrored: bool
) -> None:
    people, truth = two_people(take)
    if mirrored:
        sides = [people.names.index(other_side(name)) for name in people.names]
        frames = []
        for frame, row in zip(people.frames, truth, strict=True):
            pixel = frame.pixel.copy()
            pixel[1 - row] = 2.0 * SHIFT + pixel[row][sides] * [-1.0, 1.0] + [people.size[0], 0.0]
            frames.append(replace(frame, pixel=pixel))
        people = replace(people, frames=tuple(frames))
    faces = tuple(replace(each, face=each.pixel[:, :3].reshape(-1, 6)) for each in people.frames)
    people = replace(people, frames=faces)
    one = people_of(people, number, take.fps)
    for index, (frame, row) in enumerate(zip(people.frames, truth, strict=True)):
        wanted = row if number == 1 else 1 - row
        np.testing.assert_array_equal(one.frames[index].pixel, frame.pixel[[wanted]])
        np.testing.assert_array_equal(one.frames[index].face, frame.face[[wanted]])
    (note,) = performer_keypoints(replace(take, keyframes=(), keypoints=(people,))).notes
    assert ("mirrored copies" in note) == mirrored and "copies of each other" in note
    with pytest.raises(InputError, match="performer is 3; detector sees at most 2 people"):
        people_of(people, 3, take.fps)


@pytest.mark.parametrize("twin", [False, True])
def test_a_click_says_it_before_there_are_keyframes(take: Take, twin: bool) -> None:
    people, truth = two_people(take)
    nobody = SeenPeople(np.zeros((0, 1, 2)), np.zeros((0, 1)), np.zeros((0, 1, 3)))
    place = performer_pixels(take)[7, people.names.index("hip.L")] + twin * SHIFT
    click = SeenPeople(place[None, None], np.ones((1, 1)), np.full((1, 1, 3), np.nan))
    frames = tuple(click if index == 7 else nobody for index in range(FRAMES))
    clicks = People(("hip.L",), "clicks", people.size, frames, by_hand=True)
    found = performer_keypoints(replace(take, keyframes=(), keypoints=(people, clicks)))
    assert found.names == (*people.names, "hip.L") and found.sources[-1] == "clicks"
    wanted = [1 - row for row in truth] if twin else truth
    for index, (frame, row) in enumerate(zip(people.frames, wanted, strict=True)):
        np.testing.assert_array_equal(found.pixel[index, :-1], frame.pixel[row])
    np.testing.assert_array_equal(found.pixel[7, -1], place)
    assert "clicked" in found.notes[0]


@pytest.mark.parametrize("twin", [False, True])
def test_markers_say_it_without_keyframes(take: Take, twin: bool) -> None:
    people, truth = two_people(take)
    names = people.names
    pixel = performer_pixels(take)
    none = RegionTracks.unmarked(np.arange(FRAMES) / take.fps, take.camera.resolution)
    markers = len(take.markers)
    centroid = np.full((FRAMES, markers, 2), np.nan)
    for number, segment in enumerate(take.marker_segments):
        if segment.startswith("forearm"):
            ends = [names.index(f"{end}.{segment[-1]}") for end in ("elbow", "wrist")]
            centroid[::3, number] = pixel[::3, ends].mean(axis=1) + twin * SHIFT
    tracks = replace(
        none,
        names=tuple(style.name for style in take.markers),
        centroid=centroid,
        second_moment=np.zeros((FRAMES, markers, 2, 2)),
        area=np.ones((FRAMES, markers)),
        quality=np.ones((FRAMES, markers)),
        clipped=np.zeros((FRAMES, markers), dtype=bool),
    )
    found = performer_keypoints(replace(take, keyframes=(), keypoints=(people,)), tracks)
    assert_shows(found, people, [1 - row for row in truth] if twin else truth)
    assert "the markers show" in found.notes[0]


def test_nothing_says_it(take: Take) -> None:
    people, truth = two_people(take)
    found = performer_keypoints(replace(take, keyframes=(), keypoints=(people,)))
    same = [
        bool((found.pixel[index] == people.frames[index].pixel[row]).all()) for index, row in enumerate(truth)
    ]
    assert all(same) or not any(same)
    assert "click on another" in found.notes[0]


def test_somebody_else_is_left_out_and_noted(take: Take) -> None:
    pixel = performer_pixels(take)
    pixel[10:16] += 8 * SHIFT
    none = np.full((1, 13, 3), np.nan)
    frames = tuple(SeenPeople(pixel[index][None], np.ones((1, 13)), none) for index in range(FRAMES))
    people = People(
        take.body.skeleton.point_names, "detector", take.camera.resolution, frames, notes=("Read.",)
    )
    found = performer_keypoints(replace(take, keypoints=(people,)))
    np.testing.assert_array_equal(np.flatnonzero(~found.seen.any(axis=1)), np.arange(10, 16))
    assert found.notes[0] == "Read." and "6 of 30 frames" in found.notes[1]


def test_a_detector_of_another_clip_is_left_out(take: Take) -> None:
    pixel = performer_pixels(take)
    keyed = [keyframe.index for keyframe in take.keyframes]
    pixel[keyed[1:]] += 8 * SHIFT
    none = np.full((1, 13, 3), np.nan)
    frames = tuple(SeenPeople(pixel[index][None], np.ones((1, 13)), none) for index in range(FRAMES))
    people = People(take.body.skeleton.point_names, "detector", take.camera.resolution, frames)
    found = performer_keypoints(replace(take, keypoints=(people,)))
    assert not found.seen.any()
    (note,) = found.notes
    assert "most of the posed keyframes" in note and "left out" in note


def test_what_a_person_placed_is_taken_as_it_is(take: Take) -> None:
    far = np.full((1, 1, 2), 3.0)
    frame = SeenPeople(far, np.ones((1, 1)), np.full((1, 1, 3), np.nan))
    people = People(("head",), "tracks", take.camera.resolution, (frame,) * (FRAMES - 4), by_hand=True)
    found = performer_keypoints(replace(take, keypoints=(people,)))
    assert found.frame_count == FRAMES and found.notes == ()
    np.testing.assert_array_equal(found.seen[:, 0], np.arange(FRAMES) < FRAMES - 4)


def test_a_take_without_keypoints(take: Take, tmp_path: Path) -> None:
    found = performer_keypoints(take)
    assert found.names == () and found.frame_count == FRAMES
