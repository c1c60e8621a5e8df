"""The studio's takes: people could move so, builds move joints, and the demonstration stays."""

import sys
from pathlib import Path

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.review.score import read_truth

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from studio.catalogue import DEMONSTRATION, GREETING, TAKES  # noqa: E402
from studio.limbs import foot_clearance  # noqa: E402
from studio.performance import Performance, principal_points  # noqa: E402

OTHERS = [name for name in TAKES if name != DEMONSTRATION.name]
FASTEST_MPS = 14.0
"""Elite kicks and throws stay below, at the ankle and the wrist."""
BEYOND_LIMIT_RAD = np.radians(5.0)
BELOW_FLOOR_M = 0.04
"""A foot's mesh may dip so deep for a frame or two while it lands by angles."""


@pytest.fixture(scope="module")
def performances() -> dict[str, Performance]:
    """Every take's performance."""
    return {name: described.perform(described.seed) for name, described in TAKES.items()}


def _points(performance: Performance) -> Array:
    """(F, 13, 3) the true points."""
    return principal_points(performance, performance.middles)


@pytest.mark.parametrize("name", [DEMONSTRATION.name, GREETING.name])
def test_the_examples_are_still_composed_as_they_were(
    performances: dict[str, Performance], repository: Path, name: str
) -> None:
    points = _points(performances[name])
    truth = read_truth(repository / "presets" / "demo" / name / "truth.json", 1, len(points))
    assert np.abs(points - truth).max() < 1e-6


@pytest.mark.parametrize("name", OTHERS)
def test_joints_stay_in_their_range(performances: dict[str, Performance], name: str) -> None:
    performance = performances[name]
    values = performance.postures[performance.middles].to_vector()
    for joint in HUMAN.joints:
        if joint.limits_deg:
            columns = [HUMAN.dof_names.index(f"{joint.name}.{component}") for component in joint.components]
            lower, upper = np.radians(np.array(joint.limits_deg)).T
            beyond = np.maximum(values[:, columns] - upper, lower - values[:, columns])
            assert beyond.max() < BEYOND_LIMIT_RAD, joint.name


@pytest.mark.parametrize("name", OTHERS)
def test_nothing_is_faster_than_people_or_below_the_floor(
    performances: dict[str, Performance], name: str
) -> None:
    performance = performances[name]
    points = _points(performance)
    assert np.linalg.norm(np.diff(points, axis=0), axis=-1).max() * performance.fps < FASTEST_MPS
    for side, rotations in performance.feet.items():
        ankle = points[:, HUMAN.point_names.index(f"ankle.{side}"), 2]
        assert (ankle - foot_clearance(rotations[performance.middles])).min() > -BELOW_FLOOR_M


@pytest.mark.parametrize("name", TAKES)
def test_the_camera_sees_the_performer(performances: dict[str, Performance], name: str) -> None:
    camera = TAKES[name].camera
    pixels, depth = camera.project(_points(performances[name]))
    inside = np.all((pixels > 0.0) & (pixels < np.array(camera.resolution)), axis=-1) & (depth > 0.0)
    assert inside.mean() > 0.97


def test_a_build_moves_joints_but_no_feet(performances: dict[str, Performance]) -> None:
    performance = performances["martial"]
    assert performance.build is not None and performances["kick"].build is None
    pose = performance.body.pose(performance.postures[performance.middles])
    points, names = _points(performance), HUMAN.point_names
    beside = np.linalg.norm(points - performance.body.points(pose), axis=-1)
    assert 0.005 < beside.mean() < 0.015 and beside.max() < 0.03
    assert beside[:, [names.index("ankle.L"), names.index("ankle.R")]].max() < 1e-12
    for first, last, segment in (
        ("hip", "knee", "thigh"),
        ("knee", "ankle", "shin"),
        ("elbow", "wrist", "forearm"),
    ):
        ends = [points[:, names.index(f"{part}.L")] for part in (first, last)]
        length = np.linalg.norm(ends[1] - ends[0], axis=-1)
        assert np.abs(length - performance.body.actor.segments_m[f"{segment}.L"]).max() < 0.025
