"""The shipped libraries: as the tool composes them, complete, and such as people move."""

import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, read_library, write_library
from keymark.core.prior.motion_playback import sample_motion

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))

from libraries.catalogue import NAMES, composed  # noqa: E402
from libraries.inspection import arms_in_trunk, over_time, ranges_left, slides, soles  # noqa: E402

SHIPPED = Path(__file__).resolve().parents[3] / "presets" / "keyframes"
KINDS = {"aerobic", "balance", "jumping", "kicking", "punching", "reaching", "running", "squatting_lifting"}
KINDS |= {"turning", "walking", "waving"}
DEEPEST_M = 0.03
"""A sole may dip so deep between two postures."""
SLIDES_M = {"walking": 0.01, "running": 0.01}
MOST_SLIDE_M = 0.03
FASTEST_MPS = {"ankle": 14.0, "wrist": 13.0}


@cache
def shipped(name: str) -> Library:
    return read_library(SHIPPED / f"{name}.json")


def test_every_kind_is_shipped() -> None:
    assert set(NAMES) == KINDS
    assert {file.stem for file in SHIPPED.glob("*")} == KINDS
    assert all(shipped(name).identifier == name for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_file_is_what_the_tool_writes(name: str, tmp_path: Path) -> None:
    write_library(tmp_path / "again.json", composed(name))
    assert (tmp_path / "again.json").read_bytes() == (SHIPPED / f"{name}.json").read_bytes()


@pytest.mark.parametrize("name", NAMES)
def test_a_library_says_what_it_is(name: str) -> None:
    library = shipped(name)
    used = {step.posture for motion in library.motions for step in motion.steps}
    assert 10 <= len(library.postures) <= 40
    assert used == set(library.by_name)
    assert library.license == "CC0-1.0" and library.author and library.description and library.tags
    assert len(library.sources) >= 2
    assert all(any(year in source for year in ("(19", "(20")) for source in library.sources)


@pytest.mark.parametrize("name", NAMES)
def test_joints_stay_in_their_range(name: str) -> None:
    assert ranges_left(shipped(name)) == []


@pytest.mark.parametrize("name", NAMES)
def test_feet_bear_the_body(name: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    for motion in library.motions:
        postures, times = over_time(library, motion)
        lowest = soles(body, body.pose(postures)).min(axis=-1)
        assert -DEEPEST_M < lowest.min() < DEEPEST_M, motion.name
        assert slides(body, postures, times) < SLIDES_M.get(name, MOST_SLIDE_M), motion.name


@pytest.mark.parametrize("name", NAMES)
def test_nobody_moves_faster_than_people(name: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    for motion in library.motions:
        postures, times = over_time(library, motion)
        points = body.points(body.pose(postures))
        speed = np.linalg.norm(np.gradient(points, times, axis=0), axis=-1)
        for joint, fastest in FASTEST_MPS.items():
            columns = [i for i, point in enumerate(body.skeleton.point_names) if point.startswith(joint)]
            assert speed[:, columns].max() < fastest, f"{motion.name}: {joint}"
        assert arms_in_trunk(body, postures).max() < 0.5, motion.name


@pytest.mark.parametrize(
    ("name", "motion"),
    [("walking", "walk"), ("walking", "brisk walk"), ("running", "jog"), ("running", "run")],
)
def test_the_second_step_mirrors_the_first(name: str, motion: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    cycle = next(candidate for candidate in library.motions if candidate.name == motion)
    times = np.linspace(0.0, 0.5 * cycle.duration_s, 12)
    first = sample_motion(library, cycle, body, times)
    second = mirrored(sample_motion(library, cycle, body, times + 0.5 * cycle.duration_s))
    on = Posture(
        first.skeleton,
        second.translation - 0.5 * np.array([cycle.travel[0], cycle.travel[1], 0.0]),
        second.rotations,
        second.angles,
    )
    away = np.linalg.norm(body.points(body.pose(first)) - body.points(body.pose(on)), axis=-1)
    assert away.max() < 0.01


def test_knees_bend_as_gait_laboratories_measure() -> None:
    library = shipped("walking")
    body = Body(library.actor)
    walk = library.motions[0]
    column = body.skeleton.dof_names.index("knee.L.flexion")
    shares = np.array([0.0, 0.14, 0.40, 0.60, 0.72])
    postures = sample_motion(library, walk, body, shares * walk.duration_s)
    knee = np.degrees(postures.to_vector()[:, column])
    assert np.all(np.abs(knee - [5.0, 18.0, 7.0, 38.0, 61.0]) < 8.0), knee


def test_runners_fly() -> None:
    flies = {}
    for name, index in (("walking", 0), ("running", 0)):
        library = shipped(name)
        body = Body(library.actor)
        postures, _ = over_time(library, library.motions[index])
        flies[name] = float((soles(body, body.pose(postures)).min(axis=-1) > 0.03).mean())
    assert flies["walking"] == 0.0
    assert 0.1 < flies["running"] < 0.5
