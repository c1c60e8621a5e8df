"""Which control a bone follows, from poses of controls at random."""

import numpy as np
from keymark.core.retarget.controls.rigid_following import followed_controls
from scipy.spatial.transform import Rotation

SAMPLES, SIZE = 4, 1.7
NAMES = ["first", "second"]


def poses(rng: np.random.Generator, count: int) -> np.ndarray:
    """(SAMPLES, count, 4, 4) poses at random."""
    made = np.tile(np.eye(4), (SAMPLES, count, 1, 1))
    turns = Rotation.random(SAMPLES * count, random_state=int(rng.integers(100)))
    made[..., :3, :3] = turns.as_matrix().reshape(SAMPLES, count, 3, 3)
    made[..., :3, 3] = rng.normal(size=(SAMPLES, count, 3))
    return made


def test_a_bone_that_cannot_get_there_follows_by_its_turn() -> None:
    """Toes of a leg that does not reach its goal still turn with their control."""
    rng = np.random.default_rng(2)
    controls = poses(rng, 2)
    toe = controls[:, 0].copy()
    toe[:, :3, 3] += rng.normal(scale=0.1, size=(SAMPLES, 3))
    assert followed_controls(NAMES, controls, toe[:, None], SIZE) == ["first"]
