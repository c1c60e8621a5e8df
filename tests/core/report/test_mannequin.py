"""Pictures of postures: the right limbs in the right place."""

import numpy as np
import pytest
from _libraries import ACTOR
from keymark.core.body.body_volume import sole_heights_m, standing_posture
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.report.canvas import LEFT, RIGHT, View, view_axes
from keymark.core.report.mannequin import SIZE, draw_mannequin, mannequin, posture_picture

BODY = Body(ACTOR)
STANDING = standing_posture(BODY)


def alike(image: np.ndarray, color: tuple[int, int, int]) -> np.ndarray:
    """Mask of the pixels of a color, in any brightness."""
    wanted, shown = np.array(color, dtype=np.float64), image.astype(np.float64)
    cosine = shown @ wanted / (np.linalg.norm(shown, axis=-1) * np.linalg.norm(wanted) + 1e-9)
    return cosine > 0.985


def moved(posture: Posture, offset: tuple[float, float, float]) -> Posture:
    return Posture(posture.skeleton, posture.translation + offset, posture.rotations, posture.angles)


def test_a_posture_fills_its_picture_and_left_is_told_from_right() -> None:
    image = posture_picture(BODY, STANDING)
    assert image.shape == (SIZE, SIZE, 3) and image.dtype == np.uint8
    left, right = alike(image, LEFT), alike(image, RIGHT)
    assert 0.3 < left.sum() / right.sum() < 3.0
    rows = np.flatnonzero((left | right).any(axis=1))
    assert rows[-1] > 0.85 * SIZE and rows[0] < 0.35 * SIZE
    np.testing.assert_array_equal(image, posture_picture(BODY, STANDING))


def test_a_limb_in_front_hides_what_is_behind() -> None:
    paper = np.full((200, 200, 3), 250, dtype=np.uint8)
    image = draw_mannequin(
        paper, mannequin(BODY, STANDING), View(view_axes(0.5 * np.pi, 0.0), 90.0, (100.0, 180.0))
    )
    assert alike(image, LEFT).sum() > 20 * alike(image, RIGHT).sum()


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.3), (3.0, -2.0, 0.0)])
def test_the_picture_follows_a_leap_but_not_a_walk(offset: tuple[float, float, float]) -> None:
    here, there = (posture_picture(BODY, posture) for posture in (STANDING, moved(STANDING, offset)))
    lowest = [np.flatnonzero((alike(im, LEFT) | alike(im, RIGHT)).any(axis=1))[-1] for im in (here, there)]
    if offset[2]:
        assert lowest[1] < lowest[0] - 15
    else:
        assert np.abs(here.astype(int) - there).mean() < 1.0


def crouching(knee: float) -> Posture:
    """A posture with bent knees [rad] whose ankles are as high above the floor as in standing."""
    angles = STANDING.angles.copy()
    names = [BODY.skeleton.joints[i].name for i in BODY.skeleton.hinge_joints]
    for side in ("L", "R"):
        angles[names.index(f"knee.{side}")] = knee
    bent = Posture(STANDING.skeleton, STANDING.translation, STANDING.rotations, angles)
    ankle = BODY.skeleton.point_names.index("ankle.L")
    heights = [BODY.points(BODY.pose(posture))[ankle, 2] for posture in (bent, STANDING)]
    return moved(bent, (0.0, 0.0, float(heights[1] - heights[0])))


@pytest.mark.parametrize("knee", [0.2, 0.6, 1.2])
def test_feet_lie_on_the_floor_where_they_would_dip(knee: float) -> None:
    posture = crouching(knee)
    assert sole_heights_m(BODY, BODY.pose(posture)).max() < -0.01
    assert mannequin(BODY, posture).points[:, 2].min() > -1e-3
    high = [mannequin(BODY, moved(posture, (0.0, 0.0, height))).points for height in (0.5, 0.7)]
    np.testing.assert_allclose(high[1] - high[0], np.tile([0.0, 0.0, 0.2], (len(high[0]), 1)), atol=1e-9)


def test_the_skin_lies_around_the_bones_and_faces_outwards() -> None:
    figure = mannequin(BODY, STANDING)
    corners = figure.points[figure.triangles]
    volume_m3 = np.einsum("ti,ti->t", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    assert 0.04 < volume_m3 < 0.09
    for place in BODY.points(BODY.pose(STANDING)):
        assert np.linalg.norm(figure.points - place, axis=1).min() < 0.12
