"""What carries controls is found from random poses, whatever carries and turns them."""

from dataclasses import dataclass

import numpy as np
import pytest
from keymark.core.retarget.controls.control_channels import NOTHING, PosedControls, find_spaces, rigid_offset
from scipy.spatial.transform import Rotation

STILL, MOVED = 3, 4


@dataclass(frozen=True)
class Made:
    """A control as a test builds it."""

    turner: int
    carrier: int
    movable: bool = True
    scale: float = 1.0


MADE = (
    Made(NOTHING, NOTHING),
    Made(0, 0),
    Made(1, 1, movable=False),
    Made(NOTHING, 1),  # keeps its turn, as without Inherit Rotation
    Made(2, 0, scale=0.01),
    Made(4, 4),
)


def posed(rng: np.random.Generator, made: tuple[Made, ...] = MADE) -> tuple[PosedControls, list[np.ndarray]]:
    """Random poses of the controls, and the constant turn, origin and location axes of each."""
    count, samples = len(made), STILL + MOVED
    turns = Rotation.random(count, random_state=7).as_matrix()
    origins, axes = rng.normal(size=(count, 3)), Rotation.random(count, random_state=8).as_matrix()
    axes = axes * np.array([one.scale for one in made])[:, None, None]
    channels, poses = np.tile(np.eye(4), (2, samples, count, 1, 1))
    for sample in range(samples):
        for index, one in enumerate(made):
            channels[sample, index, :3, :3] = Rotation.from_rotvec(rng.normal(0.0, 0.4, 3)).as_matrix()
            if sample >= STILL:
                channels[sample, index, :3, 3] = rng.normal(size=3)
            turner = np.eye(4) if one.turner == NOTHING else poses[sample, one.turner]
            carrier = np.eye(4) if one.carrier == NOTHING else poses[sample, one.carrier]
            local = axes[index] @ channels[sample, index, :3, 3] if one.movable else 0.0
            poses[sample, index, :3, :3] = turner[:3, :3] @ turns[index] @ channels[sample, index, :3, :3]
            poses[sample, index, :3, 3] = carrier[:3, 3] + carrier[:3, :3] @ (origins[index] + local)
    return PosedControls(channels, poses, STILL), [turns, origins, axes]


def test_carriers_and_turners_are_found() -> None:
    controls, (turns, origins, axes) = posed(np.random.default_rng(3))
    for index, (space, made) in enumerate(zip(find_spaces(controls), MADE, strict=True)):
        assert (space.turner, space.carrier) == (made.turner, made.carrier)
        assert space.turn == pytest.approx(turns[index], abs=1e-9)
        assert space.origin == pytest.approx(origins[index], abs=1e-9)
        assert space.movable == made.movable
        if made.movable:
            assert space.axes == pytest.approx(axes[index], abs=1e-9)
        assert space.residual_rad < 1e-6 and space.residual < 1e-3


def test_what_is_not_rigid_says_by_how_much() -> None:
    controls, _ = posed(np.random.default_rng(3))
    rng = np.random.default_rng(5)
    for sample in range(STILL + MOVED):
        wobble = Rotation.from_rotvec(rng.normal(0.0, 0.05, 3)).as_matrix()
        controls.poses[sample, 5, :3, :3] = wobble @ controls.poses[sample, 5, :3, :3]
    spaces = find_spaces(controls)
    assert spaces[4].residual_rad < 1e-6
    assert 0.02 < spaces[5].residual_rad < 0.3


def test_scale_of_poses_does_not_matter() -> None:
    controls, (turns, _, _) = posed(np.random.default_rng(3))
    controls.poses[:, 1, :3, :3] *= 1.7
    space = find_spaces(controls)[1]
    assert space.turn == pytest.approx(turns[1], abs=1e-9)


def test_the_offset_of_a_bone_that_follows() -> None:
    rng = np.random.default_rng(2)
    leading, offset = np.tile(np.eye(4), (4, 1, 1)), np.eye(4)
    leading[:, :3, :3] = Rotation.random(4, random_state=1).as_matrix()
    leading[:, :3, 3] = rng.normal(size=(4, 3))
    offset[:3, :3], offset[:3, 3] = Rotation.from_rotvec([0.1, 0.2, 0.3]).as_matrix(), [0.1, 0.0, 0.4]
    following = leading @ offset
    found, turn_rad, distance = rigid_offset(leading, following)
    assert found == pytest.approx(offset, abs=1e-9)
    assert turn_rad < 1e-7
    assert distance < 1e-12
    following[2, :3, 3] += 0.04
    assert rigid_offset(leading, following)[2] == pytest.approx(0.75 * 0.04 * np.sqrt(3.0))
