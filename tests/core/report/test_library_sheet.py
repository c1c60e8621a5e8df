"""Pictures of libraries: the right limbs in the right place, every posture on the sheet."""

from dataclasses import replace

import numpy as np
import pytest
from _libraries import ACTOR, small_library
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.soles import HEEL_BEHIND, sole_heights_m, sole_places
from keymark.core.body.standing_posture import standing_posture
from keymark.core.library.library import LibraryMotion, MotionStep
from keymark.core.report.canvas import LEFT, RIGHT
from keymark.core.report.library_sheet import MARGIN, WIDTH, library_sheet
from keymark.core.report.mannequin import View, draw_mannequin
from keymark.core.report.mannequin_feet import foot_frame_index, skin_frames
from keymark.core.report.posture_picture import SIZE, posture_picture

BODY = Body(ACTOR)
STANDING = standing_posture(BODY)


def alike(image: np.ndarray, color: tuple[int, int, int]) -> np.ndarray:
    """Mask of the pixels of a color, in any brightness."""
    wanted, shown = np.array(color, dtype=np.float64), image.astype(np.float64)
    cosine = shown @ wanted / (np.linalg.norm(shown, axis=-1) * np.linalg.norm(wanted) + 1e-9)
    return cosine > 0.985


def moved(posture: Posture, offset: tuple[float, float, float]) -> Posture:
    """The posture, moved."""
    return Posture(posture.skeleton, posture.translation + offset, posture.rotations, posture.angles)


def test_a_posture_fills_its_picture_and_left_is_told_from_right() -> None:
    """Both sides' limbs are there, in about the same amount, and most of the height is used."""
    image = posture_picture(BODY, STANDING)
    assert image.shape == (SIZE, SIZE, 3) and image.dtype == np.uint8
    left, right = alike(image, LEFT), alike(image, RIGHT)
    assert 0.3 < left.sum() / right.sum() < 3.0
    rows = np.flatnonzero((left | right).any(axis=1))
    assert rows[-1] > 0.85 * SIZE and rows[0] < 0.35 * SIZE
    np.testing.assert_array_equal(image, posture_picture(BODY, STANDING))


def test_the_eye_stands_where_the_view_says() -> None:
    """From the front the performer's left is at the right of the picture, from behind at the left."""
    paper = np.full((200, 200, 3), 250, dtype=np.uint8)
    for turn, side in ((0.0, 1.0), (np.pi, -1.0)):
        image = draw_mannequin(paper, BODY, STANDING, View(turn, 0.1, 90.0, (100.0, 180.0)))
        assert side * (np.nonzero(alike(image, LEFT))[1].mean() - 100.0) > 10.0
        assert side * (np.nonzero(alike(image, RIGHT))[1].mean() - 100.0) < -10.0
    assert (paper == 250).all()


def test_a_limb_in_front_hides_what_is_behind() -> None:
    """Seen from its left, a standing person's right leg hardly shows."""
    paper = np.full((200, 200, 3), 250, dtype=np.uint8)
    image = draw_mannequin(paper, BODY, STANDING, View(0.5 * np.pi, 0.0, 90.0, (100.0, 180.0)))
    assert alike(image, LEFT).sum() > 20 * alike(image, RIGHT).sum()


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.3), (3.0, -2.0, 0.0)])
def test_the_picture_follows_a_leap_but_not_a_walk(offset: tuple[float, float, float]) -> None:
    """A leaping figure is above the floor; one that has walked away is centered nevertheless."""
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
    """The rigid foot of a leaning shin dips; drawn, its sole is level, and its ankle stays where it was."""
    posture = crouching(knee)
    pose = BODY.pose(posture)
    turned, origins = skin_frames(BODY, posture)
    assert sole_heights_m(BODY, pose).max() < -0.01
    for side, heights in zip(("L", "R"), sole_places(BODY, pose)[..., 2], strict=True):
        foot = next(segment for segment in BODY.skeleton.segments if segment.name == f"foot.{side}")
        frame = foot_frame_index(BODY, foot.name)
        ankle, tip = (BODY.local(end) for end in (foot.start, foot.end))
        heel = np.array([tip[0], ankle[1] + HEEL_BEHIND * BODY.actor.segments_m[foot.name], tip[2]])
        drawn = [(origins[frame] + turned[frame] @ place)[2] for place in (heel, tip)]
        assert min(drawn) > -1e-3 > heights.min()
        at = origins[frame] + turned[frame] @ ankle
        np.testing.assert_allclose(at, pose.place(foot.joint, ankle), atol=1e-9)
        np.testing.assert_allclose(turned[frame].T @ turned[frame], np.eye(3), atol=1e-9)


def test_a_foot_in_the_air_is_drawn_as_the_shin_has_it() -> None:
    """A foot above the floor keeps its rotation."""
    posture = moved(crouching(0.8), (0.0, 0.0, 0.5))
    pose = BODY.pose(posture)
    turned, _ = skin_frames(BODY, posture)
    for side in ("L", "R"):
        foot = next(segment for segment in BODY.skeleton.segments if segment.name == f"foot.{side}")
        frame = foot_frame_index(BODY, foot.name)
        np.testing.assert_allclose(turned[frame], pose.rotation[foot.joint], atol=1e-12)


def test_every_posture_is_on_the_sheet() -> None:
    """A figure for each step of each motion and for each posture in none; any letters are accepted."""
    library = small_library()
    both, first, none = (
        library_sheet(replace(library, motions=motions, title="Schritte 歩く", description="ö" * 500))
        for motions in (library.motions, library.motions[:1], ())
    )
    shown = [int(alike(sheet[90:], RIGHT).sum()) for sheet in (both, first, none)]
    assert shown[0] == pytest.approx(5.0 / 3.0 * shown[1], rel=0.25)
    assert shown[1] == pytest.approx(shown[2], rel=0.25)


def test_a_long_motion_goes_on_in_the_next_row() -> None:
    """Several rows share the postures evenly."""
    library = small_library()
    names = [posture.name for posture in library.postures]
    steps = tuple(MotionStep(names[n % 3], 0.1 * n) for n in range(18))
    long = library_sheet(replace(library, motions=(LibraryMotion("Long", steps, 2.0),)))
    short = library_sheet(replace(library, motions=(LibraryMotion("Short", steps[:9], 2.0),)))
    assert long.shape[1] <= WIDTH + 2 * MARGIN and long.shape[0] > short.shape[0] + 150


def test_short_motions_lie_side_by_side() -> None:
    """Two strips that fit into one row share it."""
    library = small_library()
    one, other = library.motions[0], replace(library.motions[0], name="Again")
    sheets = [library_sheet(replace(library, motions=motions)) for motions in ((one,), (one, other))]
    assert sheets[0].shape[0] == sheets[1].shape[0]
    drawn = [int(alike(sheet[90:], RIGHT).sum()) for sheet in sheets]
    assert drawn[1] == pytest.approx(2.0 * drawn[0], rel=0.05)
