"""Turned performers: they face as asked, at their place, and the image stays as far as it can."""

import numpy as np
import pytest
from _performances import (
    BODY,
    POINT,
    camera_around,
    camera_at,
    natural_posture,
    pixels,
    points,
    segment_lengths,
)
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.mirror import other_side
from keymark.core.body.posture import Posture
from keymark.core.poses.turned import Facing, Sides, facing_of, turned

FRONT = camera_at(np.array([0.0, -4.0, 1.2]))
LIMB_JOINTS = [POINT[f"{stem}.{side}"] for stem in ("elbow", "wrist", "knee", "ankle") for side in ("L", "R")]
SWAPPED = [POINT[other_side(name)] for name in HUMAN.point_names]


@pytest.mark.parametrize("sides", Sides)
@pytest.mark.parametrize("facing", Facing)
@pytest.mark.parametrize("seed", range(3))
def test_the_performer_faces_as_asked_and_stays_in_place(seed: int, facing: Facing, sides: Sides) -> None:
    posture, camera = natural_posture(seed, 0.4), camera_around(seed)
    result = turned(BODY, posture, camera, facing, sides)
    assert facing_of(result.posture, camera) is facing
    np.testing.assert_allclose(result.posture.translation, posture.translation)
    np.testing.assert_allclose(segment_lengths(result.posture), segment_lengths(posture), atol=1e-9)


def test_left_and_right_are_those_of_the_picture() -> None:
    left = turned(BODY, standing_posture(BODY), FRONT, Facing.LEFT, Sides.TURN).posture
    ends = BODY.segment_ends(BODY.pose(left), "foot.L")
    heel, toe = (FRONT.project(end)[0] for end in ends)
    assert toe[0] < heel[0] - 10.0


def test_a_turntable_turns_everything() -> None:
    posture = natural_posture(1)
    result = turned(BODY, posture, FRONT, Facing.AWAY, Sides.TURN).posture
    np.testing.assert_allclose(result.minus(posture)[6:], 0.0, atol=1e-9)


def test_exchanged_sides_leave_the_outline() -> None:
    vector = standing_posture(BODY).to_vector()
    for name, value in {
        "hip.L.rotation_x": -0.9,
        "knee.L.flexion": 1.0,
        "shoulder.R.rotation_y": -0.3,
    }.items():
        vector[HUMAN.dof_names.index(name)] = value
    posture = Posture.from_vector(HUMAN, vector)
    result = turned(BODY, posture, FRONT, Facing.AWAY, Sides.EXCHANGE)
    off = np.linalg.norm(pixels(result.posture, FRONT)[SWAPPED] - pixels(posture, FRONT), axis=-1)
    assert np.median(off) < 1.0 and off.max() < 15.0  # joint limits hold a knee back
    assert result.strain < turned(BODY, posture, FRONT, Facing.AWAY, Sides.STAY).strain


def test_staying_sides_leave_each_limb_where_it_is_seen() -> None:
    posture = standing_posture(BODY, arms_lowered_rad=1.2)
    result = turned(BODY, posture, FRONT, Facing.LEFT, Sides.STAY).posture
    along = turned(BODY, posture, FRONT, Facing.LEFT, Sides.TURN).posture
    shown = pixels(posture, FRONT)[LIMB_JOINTS]
    kept, lost = (np.abs(pixels(each, FRONT)[LIMB_JOINTS] - shown).mean() for each in (result, along))
    assert kept < 0.5 * lost


def test_a_camera_straight_above_has_directions_too() -> None:
    matrix = np.eye(4)
    matrix[2, 3] = 5.0
    above = type(FRONT)(35.0, 36.0, (1280, 720), matrix)
    result = turned(BODY, standing_posture(BODY), above, Facing.CAMERA, Sides.TURN).posture
    assert np.abs(points(result) - points(standing_posture(BODY))).max() < 1e-9
