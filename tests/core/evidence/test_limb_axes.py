"""The axes of limbs in the image."""

import numpy as np
import pytest
from _scene import BODY, CAMERA, exercise
from keymark.core.body.body_volume import PieceStack, body_pieces
from keymark.core.body.human import HUMAN
from keymark.core.evidence.contours import FREE, UNKNOWN, LimbAxes

AXES = LimbAxes(PieceStack.of(body_pieces(BODY)), CAMERA)
NAMES = AXES.parts.segments
FRAME = np.arange(1)
STEP = 1e-5


@pytest.mark.parametrize("seed", range(3))
def test_the_jacobian_agrees_with_central_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    posture = exercise(1).plus(0.1 * rng.normal(size=(1, HUMAN.dof_count)))
    share = rng.uniform(size=(1, len(NAMES)))
    direction = rng.normal(size=(1, len(NAMES), 2))
    pose = BODY.pose(posture)
    world, _ = AXES.points(pose, FRAME, share)
    ours = AXES.jacobian(pose, FRAME, world, direction)[0]

    def along(step: np.ndarray) -> np.ndarray:
        moved = BODY.pose(posture.plus(step[None]))
        return np.sum(direction * AXES.points(moved, FRAME, share)[1], axis=-1)[0]

    theirs = np.stack([(along(s) - along(-s)) / (2 * STEP) for s in STEP * np.eye(HUMAN.dof_count)], axis=-1)
    np.testing.assert_allclose(ours, theirs, atol=1e-3 * np.abs(theirs).max())


def test_what_lies_beyond_a_part_is_its_own_side_s() -> None:
    """A forearm lies between its upper arm and its hand; beyond hands, feet and crown is the background."""
    beyond = dict(zip(NAMES, AXES.beyond.tolist(), strict=True))
    assert beyond["forearm.R"] == [NAMES.index("upper_arm.R"), NAMES.index("hand.R")]
    assert beyond["head"] == [NAMES.index("chest"), FREE]
    assert beyond["hand.L"][1] == beyond["foot.R"][1] == FREE
    assert beyond["upper_arm.L"][0] == UNKNOWN
