"""Libraries learned from motions: which postures, where they stand, and what repeats itself."""

from pathlib import Path

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture, headings_rad, turned_and_shifted
from keymark.core.body.skeleton import SIDES
from keymark.core.errors import InputError
from keymark.core.prior.learning import LibraryMetadata, ankle_heights, learn_library, on_floor
from keymark.core.prior.library import read_library, write_library

BODY = Body(Actor.from_stature(1.8))
COLUMN = {name: place for place, name in enumerate(BODY.skeleton.dof_names)}
ABOUT = LibraryMetadata("Anna's Stroll", "Anna", "CC0-1.0")
FPS = 30.0
PERIOD_S, STRIDE_M = 1.1, 1.3


def stepping(frames: int) -> tuple[Posture, Array]:
    """Someone who walks along -Y."""
    time_s = np.arange(frames) / FPS
    phase = 2.0 * np.pi * time_s / PERIOD_S
    base = standing_posture(BODY).to_vector()
    vector = np.tile(base, (frames, 1))
    for side, sign in zip(SIDES, (1.0, -1.0), strict=True):
        vector[:, COLUMN[f"hip.{side}.rotation_x"]] += -0.45 * sign * np.sin(phase)
        vector[:, COLUMN[f"knee.{side}.flexion"]] += 0.45 - 0.4 * np.cos(phase + 0.5 * np.pi * sign)
        vector[:, COLUMN[f"elbow.{side}.flexion"]] += 0.3 + 0.2 * sign * np.sin(phase)
    vector[:, :3] = base[:3] + [0.0, 0.0, -0.03]
    posture = Posture.from_vector(BODY.skeleton, vector)
    way = STRIDE_M / PERIOD_S * time_s[:, None] * [0.0, -1.0, 0.0]
    return turned_and_shifted(posture, 0.0, way), time_s


def reaching(frames: int = 90) -> tuple[Posture, Array]:
    """Someone who stands, raises an arm once, and keeps it there."""
    time_s = np.arange(frames) / FPS
    vector = np.tile(standing_posture(BODY).to_vector(), (frames, 1))
    vector[:, COLUMN["shoulder.L.rotation_y"]] -= 1.8 / (1.0 + np.exp(-6.0 * (time_s - 1.0)))
    return Posture.from_vector(BODY.skeleton, vector), time_s


def test_a_walk_goes_straight_ahead_on_the_floor() -> None:
    posture, time_s = stepping(118)
    elsewhere = turned_and_shifted(posture, 2.0, np.array([3.0, -1.0, 0.7]))
    library = learn_library(BODY, elsewhere, time_s, ABOUT)
    (motion,) = library.motions
    assert 10 <= len(library.postures) <= 40 and len(motion.steps) == len(library.postures)
    kept = Posture.stack([posture.posture for posture in library.postures])
    assert np.abs(headings_rad(kept)).max() < 1e-3
    assert abs(np.median(ankle_heights(BODY, kept).min(axis=1))) < 0.03
    assert np.allclose(kept.translation[0, :2], 0.0)


def test_place_and_direction_do_not_matter() -> None:
    posture, time_s = reaching()
    one = learn_library(BODY, posture, time_s, ABOUT)
    other = learn_library(BODY, turned_and_shifted(posture, -1.3, np.array([5.0, 2.0, -0.4])), time_s, ABOUT)
    assert [step.time_s for step in one.motions[0].steps] == [step.time_s for step in other.motions[0].steps]
    for mine, its in zip(one.postures, other.postures, strict=True):
        assert np.abs(mine.posture.minus(its.posture)).max() < 1e-9


@pytest.mark.parametrize(("bend_rad", "tags"), [(0.58, ()), (0.66, ("right foot up",))])
def test_a_posture_says_which_foot_is_lifted(bend_rad: float, tags: tuple[str, ...]) -> None:
    vector = np.tile(standing_posture(BODY).to_vector(), (40, 1))
    vector[20:, COLUMN["knee.R.flexion"]] += bend_rad
    posture = Posture.from_vector(BODY.skeleton, vector)
    apart_m = np.ptp(ankle_heights(BODY, posture[39:]))
    assert apart_m == pytest.approx(0.08, abs=0.02) and (apart_m > 0.08) == bool(tags)
    library = learn_library(BODY, posture, np.arange(40) / FPS, ABOUT)
    assert {posture.tags for posture in library.postures} == {(), tags}


def test_a_motion_stays_whole() -> None:
    posture, time_s = reaching()
    library = learn_library(BODY, posture, time_s, ABOUT, count=12)
    (motion,) = library.motions
    assert not motion.cyclic and motion.travel == (0.0, 0.0, 0.0) and len(library.postures) == 12
    times = [step.time_s for step in motion.steps]
    assert times[0] == 0.0 and times[-1] == motion.duration_s == pytest.approx(time_s[-1], abs=1e-3)
    assert sum(0.5 <= time <= 1.5 for time in times) > len(times) / 3
    assert max(np.diff(times)) < 1.0


@pytest.mark.parametrize(
    ("frames", "count", "sentence"),
    [(5, 10, "5 frames"), (60, 1, "count of postures is 1"), (60, None, "still")],
)
def test_what_cannot_be_learned_from_is_refused(frames: int, count: int | None, sentence: str) -> None:
    still = Posture.from_vector(BODY.skeleton, np.tile(standing_posture(BODY).to_vector(), (frames, 1)))
    with pytest.raises(InputError, match=sentence):
        learn_library(BODY, still, np.arange(frames) / FPS, ABOUT, count)


def test_what_is_learned_can_be_written_and_read(tmp_path: Path) -> None:
    posture, time_s = reaching()
    identifier = "anna_reaches_for_the_cup_on_the_shelf_then_drinks_from_it"
    about = LibraryMetadata("Anna reaches for the cup on the shelf, then drinks from it.", "Anna")
    library = learn_library(BODY, posture, time_s, about)
    write_library(tmp_path / "it.json", library)
    read = read_library(tmp_path / "it.json")
    assert read.identifier == library.identifier == identifier
    assert read.motions == library.motions and read.license == "LicenseRef-Proprietary"
    assert [posture.name for posture in read.postures] == [step.posture for step in read.motions[0].steps]
    for written, its in zip(library.postures, read.postures, strict=True):
        assert np.abs(written.posture.minus(its.posture)).max() < 1e-8


def test_a_motion_is_put_on_the_floor_by_its_resting_feet() -> None:
    posture, time_s = stepping(60)
    low = turned_and_shifted(posture, 0.0, np.array([0.4, -0.2, -0.7]))
    on = on_floor(BODY, low, time_s)
    again = turned_and_shifted(on, 0.0, np.array([0.0, 0.0, 0.31]))
    np.testing.assert_allclose(on_floor(BODY, again, time_s).translation, on.translation, atol=1e-9)
    np.testing.assert_allclose(on.translation[:, :2], low.translation[:, :2], atol=1e-9)
    np.testing.assert_allclose(on.rotations, low.rotations, atol=1e-9)
    assert abs(np.median(ankle_heights(BODY, on).min(axis=-1))) < 0.05
