"""The performer among several people, and its principal points as several sources show them."""

import numpy as np
import pytest
from keymark.core.arrays import Array, IndexArray
from keymark.core.body.human import HUMAN, TRUNK, limb_of
from keymark.core.body.skeleton import SIDES
from keymark.core.detect.keypoints import Keypoints
from keymark.core.detect.performer import (
    MOST_CANDIDATES,
    NOBODY,
    Expected,
    Sightings,
    choose_performer,
    performer_size_px,
    principal_keypoints,
)

FPS = 30.0
FIGURE = np.array([[0, 0], [-8, 12], [8, 12], [-6, 40], [6, 40], [-7, 75], [7, 75]], dtype=np.float64)
"""Points of a person 75 px tall."""


def walker(
    start: tuple[float, float], velocity: tuple[float, float], frames: int, seed: int, swing: float = 4.0
) -> Array:
    """(F, 7, 2) somebody who crosses the picture with swinging limbs and a detector's noise."""
    generator = np.random.default_rng(seed)
    time = np.arange(frames)[:, None]
    place = np.array(start) + time * np.array(velocity)
    limbs = swing * np.sin(0.4 * time + np.arange(len(FIGURE)) * (1 + seed))
    points = FIGURE + place[:, None]
    points[:, :, 0] += limbs
    return points + generator.normal(scale=0.7, size=points.shape)


def scene(people: list[Array], present: Array, seed: int = 0) -> tuple[Sightings, IndexArray]:
    """People in random order a frame, and the index of the first of them, `NOBODY` where missing."""
    generator = np.random.default_rng(seed)
    pixels, scores, truth = [], [], []
    for frame in range(len(people[0])):
        order = [int(one) for one in generator.permutation(len(people)) if present[frame, one]]
        pixels.append(np.array([people[one][frame] for one in order]).reshape(-1, len(FIGURE), 2))
        scores.append(np.full((len(order), len(FIGURE)), 0.9))
        truth.append(order.index(0) if 0 in order else NOBODY)
    return Sightings(tuple(pixels), tuple(scores)), np.array(truth)


def expected_from(person: Array, every: int, std_px: float = 5.0) -> Expected:
    """The person as keyframes of every so many frames would have it, interpolated linearly."""
    frames = len(person)
    keys = np.arange(0, frames, every)
    flat = person.reshape(frames, -1)
    between = np.stack([np.interp(np.arange(frames), keys, column[keys]) for column in flat.T], 1)
    away = np.abs(np.arange(frames)[:, None] - keys).min(axis=1)
    std = np.repeat((std_px + 1.0 * away)[:, None], person.shape[1], axis=1)
    weight = np.where(away == 0, 3.0, 1.0)
    return Expected(between.reshape(person.shape), std, weight)


@pytest.mark.parametrize("missing", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("knows", ["keyframes", "one click"])
def test_two_people_who_cross(missing: float, knows: str) -> None:
    frames = 90
    people = [walker((20, 60), (2.5, 0), frames, 0), walker((240, 62), (-2.5, 0), frames, 1)]
    present = np.random.default_rng(4).random((frames, 2)) >= missing
    present[0] = True
    seen, truth = scene(people, present)
    expected = expected_from(people[0], 12)
    if knows == "one click":
        only = np.full_like(expected.pixel, np.nan)
        only[0, 3] = people[0][0, 3]
        expected = Expected(only, expected.std_px, expected.weight)
    assert (choose_performer(seen, expected, FPS) == truth).mean() > 0.97


def test_a_performer_who_is_hidden_is_nobody() -> None:
    frames = 100
    people = [walker((40, 60), (1.5, 0), frames, 0), walker((200, 50), (0, 0), frames, 1)]
    present = np.ones((frames, 2), dtype=bool)
    present[40:65, 0] = False
    seen, truth = scene(people, present)
    np.testing.assert_array_equal(choose_performer(seen, expected_from(people[0], 15), FPS), truth)


def test_without_any_hint_the_largest_who_stays_is_followed() -> None:
    frames = 80
    people = [
        walker((60, 60), (1.0, 0), frames, 0),
        0.5 * walker((300, 150), (-2.0, 0), frames, 1),
        1.3 * walker((150, 20), (0, 0), frames, 2),
    ]
    present = np.ones((frames, 3), dtype=bool)
    present[:, 2] = False
    present[30:34, 2] = True
    present[50:55, 0] = False
    seen, truth = scene(people, present)
    chosen = choose_performer(seen, None, FPS)
    np.testing.assert_array_equal(chosen, truth)


def test_a_crowd_is_searched_where_the_performer_is_expected() -> None:
    frames = 25
    people = [walker((30, 60), (2.0, 0), frames, 0)]
    generator = np.random.default_rng(8)
    people += [
        walker((generator.uniform(0, 600), generator.uniform(0, 300)), (0, 0), frames, 1 + index)
        for index in range(3 * MOST_CANDIDATES)
    ]
    seen, truth = scene(people, np.ones((frames, len(people)), dtype=bool))
    assert (choose_performer(seen, expected_from(people[0], 8), FPS) == truth).mean() > 0.95


HEAD, WRIST = HUMAN.point_names.index("head"), HUMAN.point_names.index("wrist.L")


def seen(points: dict[str, tuple[float, float]], score: float = 0.9) -> Keypoints:
    pixel = np.array([list(points.values())])
    shape = pixel.shape[:2]
    sources = (f"sure to {score}",) * len(points)
    return Keypoints(tuple(points), sources, pixel, np.full(shape, score), np.full((*shape, 3), np.nan))


def test_the_heads_center_is_halfway_between_the_ears() -> None:
    face = {"nose": (50.0, 20.0), "ear.L": (60.0, 10.0), "ear.R": (40.0, 12.0)}
    both, nose = principal_keypoints(seen(face)), principal_keypoints(seen({"nose": (50.0, 20.0)}))
    np.testing.assert_allclose(both.pixel[0, HEAD], [50.0, 11.0])
    np.testing.assert_allclose(nose.pixel[0, HEAD], [50.0, 20.0])
    assert nose.score[0, HEAD] < 0.5 * both.score[0, HEAD]
    own = principal_keypoints(seen({"head": (7.0, 8.0), **face}))
    np.testing.assert_allclose(own.pixel[0, HEAD], [7.0, 8.0])


def test_sources_that_agree_are_averaged_and_a_lone_one_that_does_not_is_left_out() -> None:
    first = seen({"wrist.L": (10.0, 0.0), "ankle.L": (0.0, 100.0)}, 0.8)
    near, far = seen({"wrist.L": (14.0, 0.0)}, 0.4), seen({"wrist.L": (40.0, 0.0)}, 0.4)
    with_near = principal_keypoints(Keypoints.side_by_side([first, near], 1))
    with_far = principal_keypoints(Keypoints.side_by_side([far, first], 1))
    np.testing.assert_allclose(with_near.pixel[0, WRIST], [(0.8 * 10.0 + 0.4 * 14.0) / 1.2, 0.0])
    np.testing.assert_allclose(with_far.pixel[0, WRIST], [10.0, 0.0])
    assert with_far.score[0, WRIST] == 0.8


def test_what_nothing_shows_is_missing() -> None:
    found = principal_keypoints(seen({"wrist.L": (10.0, 0.0)}))
    assert found.seen.sum() == 1
    assert not principal_keypoints(Keypoints.none(4)).seen.any()
    np.testing.assert_array_equal(performer_size_px(Keypoints.none(4)), np.zeros(4))


def test_every_segment_and_point_belongs_to_a_part_of_the_body() -> None:
    names = [*(segment.name for segment in HUMAN.segments), *HUMAN.point_names]
    found = {limb_of(name) for name in names}
    assert found == {TRUNK, *(f"{limb}.{side}" for limb in ("arm", "leg") for side in SIDES)}
    assert limb_of("shoulder.L") == limb_of("hip.R") == limb_of("nose") == TRUNK
    assert limb_of("toe.R") == "leg.R"
