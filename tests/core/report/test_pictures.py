"""Pictures of a result: drawn at the right pixels, and without errors for any motion."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from _review import made_up_keypoints
from _synthetic_take import BODY, CAMERA, SIZE, true_postures, write_synthetic_take
from keymark.core.footage.camera import Camera
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.observation.contours import ContourModel
from keymark.core.report.body_outlines import OUTLINE
from keymark.core.report.canvas import ACCENT, INK, LEFT, RIGHT, Canvas, ticks, write_png
from keymark.core.report.contact_sheet import evenly_spaced_frames
from keymark.core.report.keypoint_marks import SOURCE_COLORS, THROWN_OUT
from keymark.core.report.overlay_sheet import CELL_WIDTH, overlay_sheet
from keymark.core.report.pictures import PICTURES, write_pictures
from keymark.core.report.speed_plot import speed_plot
from keymark.core.report.view_sheet import view_sheet
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 20
CAMERA_AHEAD = Camera.from_dict(CAMERA)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """A take with a clip."""
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("report") / "take", FRAMES))


@pytest.fixture
def motion() -> Motion:
    """The true motion of that take."""
    posture = true_postures(FRAMES)
    points = BODY.points(BODY.pose(posture))
    unknown = np.full((FRAMES, 13, 3, 3), np.nan)
    return Motion(BODY, 30.0, 1, np.arange(FRAMES) / 30.0, posture, points, unknown, (0, 8, 19), "map")


@pytest.fixture
def tracks() -> RegionTracks:
    """One marker in the picture's middle, hidden in the first frame; the others never seen."""
    centroid = np.full((FRAMES, 5, 2), np.nan)
    centroid[1:, 0] = (SIZE[0] / 2, SIZE[1] / 2)
    moment = np.full((FRAMES, 5, 2, 2), np.nan)
    moment[1:, 0] = np.diag([40.0, 90.0])
    none = np.zeros((FRAMES, 5))
    names = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
    return RegionTracks(names, centroid, moment, none, none, none > 0, np.arange(FRAMES) / 30.0, SIZE)


def count(image: np.ndarray, color: tuple[int, int, int], tolerance: int = 12) -> int:
    """Number of pixels of about this color."""
    return int((np.abs(image.astype(int) - color).max(axis=-1) <= tolerance).sum())


def test_all_pictures_are_written(take: Take, motion: Motion, tracks: RegionTracks, tmp_path: Path) -> None:
    """Every named file is a readable picture that is not blank."""
    files = write_pictures(tmp_path / "report", take, motion, tracks, np.linspace(0.0, 9.0, FRAMES))
    assert [file.name for file in files] == list(PICTURES)
    for file in files:
        image = cv2.imread(str(file))
        assert image is not None and image.std() > 5.0


def test_large_frames_are_kept_no_larger_than_drawn(
    take: Take, motion: Motion, tracks: RegionTracks, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a clip in 5K the sheet gets frames of twice its cells' width, in the clip's proportions."""
    images = tmp_path / "images"
    images.mkdir()
    for index in range(2):
        cv2.imwrite(str(images / f"{index:04d}.jpg"), np.full((2880, 5120, 3), 90, dtype=np.uint8))
    sizes = []

    def sheet(*given: object) -> np.ndarray:
        sizes.extend(image.shape[:2] for image in given[3].values())
        return np.zeros((8, 8, 3), dtype=np.uint8)

    monkeypatch.setattr("keymark.core.report.pictures.overlay_sheet", sheet)
    speed = np.linspace(0.0, 9.0, FRAMES)
    write_pictures(tmp_path / "report", replace(take, clip=images), motion, tracks, speed)
    assert sizes and set(sizes) == {(450, 800)}


def test_the_skeleton_lies_on_the_projected_joints(take: Take, motion: Motion, tracks: RegionTracks) -> None:
    """In the sheet's first cell the left elbow has the left's color where the camera projects it."""
    plain = np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8)
    image = overlay_sheet(take, motion, tracks, {0: plain})
    scale = CELL_WIDTH / SIZE[0]
    names = BODY.skeleton.point_names
    for side, color in (("L", LEFT), ("R", RIGHT)):
        pixel, _ = take.camera.project(motion.points[0, names.index(f"elbow.{side}")])
        column, row = (scale * pixel + (16, 16 + 34)).astype(int)
        around = image[row - 4 : row + 5, column - 4 : column + 5]
        assert count(around, color, 40) > 5
        elsewhere = image[row - 4 : row + 5, column + 60 : column + 69]
        assert count(elsewhere, color, 40) == 0


def test_hidden_markers_and_points_behind_the_camera_draw_nothing(
    take: Take, motion: Motion, tracks: RegionTracks
) -> None:
    """A performer behind the camera and a hidden marker leave the footage as it is."""
    plain = np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8)
    behind = replace(
        motion,
        points=motion.points - [0.0, 50.0, 0.0],
        posture=motion.posture.plus(-50.0 * np.eye(len(BODY.skeleton.dof_names))[1]),
    )
    image = overlay_sheet(take, behind, tracks, {0: plain})
    cell = image[50 : 50 + 270, 16 : 16 + CELL_WIDTH]
    assert cell.std(axis=(0, 1)).max() < 1.0
    assert overlay_sheet(take, behind, tracks, {1: plain})[50:320, 16:416].std() > 1.0


def test_keypoints_lie_where_they_were_seen(take: Take, motion: Motion, tracks: RegionTracks) -> None:
    """A cross in its source's color, a ring where the motion puts it; another color if not believed."""
    plain = np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8)
    keypoints = made_up_keypoints(FRAMES)
    keypoints.seen[:, :, 0] += 40.0  # away from the figure
    image = overlay_sheet(take, motion, tracks, {0: plain, 1: plain}, keypoints)
    without = overlay_sheet(take, motion, tracks, {0: plain, 1: plain})
    scale = CELL_WIDTH / SIZE[0]

    def around(frame: int, pixel: np.ndarray) -> tuple[slice, slice]:
        column, row = (scale * pixel + (16 + frame * (CELL_WIDTH + 8), 16 + 34)).astype(int)
        return slice(row - 4, row + 5), slice(column - 4, column + 5)

    for index, color in ((0, SOURCE_COLORS[0]), (2, SOURCE_COLORS[1])):
        assert count(image[around(0, keypoints.seen[0, index])], color, 60) > 2
    assert count(image[around(1, keypoints.seen[1, 0])], THROWN_OUT, 60) > 2
    changed = (image != without).any(axis=-1)
    assert changed[around(0, keypoints.predicted[0, 1])].any()
    hidden = overlay_sheet(take, motion, tracks, {2: plain}, keypoints)  # the first one is not seen there
    assert count(hidden, SOURCE_COLORS[0], 60) < count(image, SOURCE_COLORS[0], 60)


def test_contours_are_drawn_only_where_there_are_no_markers(
    take: Take, motion: Motion, tracks: RegionTracks
) -> None:
    """Beside the limbs, in their own color."""
    plain = np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8)
    contours = ContourModel.average(BODY, take.camera)
    bare = RegionTracks.unmarked(tracks.time_s, SIZE)
    unmarked = replace(take, markers=())
    drawn = overlay_sheet(unmarked, motion, bare, {0: plain}, contours=contours)
    assert count(drawn, OUTLINE, 40) > 100
    marked = overlay_sheet(take, motion, tracks, {0: plain}, contours=contours)
    assert count(marked, OUTLINE, 40) < 20


def test_keyframes_are_circled_at_their_value() -> None:
    """The curve's keyframes carry rings; other frames do not."""
    speed = np.zeros(101)
    speed[50] = 10.0
    without, with_key = speed_plot(speed, [], 1), speed_plot(speed, [50], 1)
    changed = np.argwhere((without != with_key).any(axis=-1))
    rows, columns = changed.min(axis=0), changed.max(axis=0)
    assert abs((rows[1] + columns[1]) / 2 - (72 + 0.5 * (1200 - 24 - 72))) < 2.0
    assert count(with_key, ACCENT) > count(without, ACCENT) + 30


@pytest.mark.parametrize(
    "speed",
    [np.zeros(5), np.full(5, np.nan), np.array([1e-9, 1e9, 3.0]), np.zeros(1), np.array([np.nan, 2.0, 5.0])],
)
def test_any_speed_can_be_plotted(speed: np.ndarray) -> None:
    """Still, hidden, immense and single frames give a picture with axes."""
    image = speed_plot(speed, [0], -3)
    assert image.shape == (420, 1200, 3) and count(image, INK, 60) > 100


def test_side_view_shows_depth_and_front_view_does_not(motion: Motion) -> None:
    """An arm stretched away from the camera is wide from the side and narrow from the front."""
    names = BODY.skeleton.dof_names
    vector = np.zeros((FRAMES, len(names)))
    vector[:, names.index("shoulder.L.rotation_z")] = -np.pi / 2
    vector[:, names.index("shoulder.R.rotation_y")] = -np.pi / 2
    posture = type(motion.posture).from_vector(BODY.skeleton, vector)
    reaching = replace(motion, posture=posture, points=BODY.points(BODY.pose(posture)))
    spans = {}
    for view in ("front", "side"):
        image = view_sheet(view, reaching, CAMERA_AHEAD, [5])
        drawn = np.argwhere(np.abs(image[52:260].astype(int) - LEFT).max(axis=-1) <= 12)
        upper = drawn[drawn[:, 0] < 105]
        spans[view] = float(np.ptp(upper[:, 1])) if len(upper) else 0.0
    assert spans["side"] > 1.5 * spans["front"]


@pytest.mark.parametrize("pitch", [-90.0, 90.0])
def test_a_camera_that_looks_straight_down_or_up_has_views(motion: Motion, pitch: float) -> None:
    """Where the camera has no level direction, the picture's upper edge is ahead."""
    turn = np.radians(90.0 + pitch)
    matrix = np.eye(4)
    matrix[1:3, 1:3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    camera = Camera.from_dict({**CAMERA, "matrix_world": matrix.tolist()})
    assert count(view_sheet("top", motion, camera, [0, 5]), LEFT) > 50


@pytest.mark.parametrize(("frame_count", "shown"), [(1, 1), (2, 2), (12, 12), (118, 12)])
def test_frames_shown_are_spread_from_first_to_last(frame_count: int, shown: int) -> None:
    """At most twelve frames, with both ends, without repetition."""
    frames = evenly_spaced_frames(frame_count)
    assert len(frames) == shown and frames[0] == 0 and frames[-1] == frame_count - 1
    assert len(set(np.diff(frames))) <= 2


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (1.0, 118.0), (0.0, 0.003), (-7.0, 3.0), (5.0, 5.0)])
def test_ticks_are_round_and_inside(low: float, high: float) -> None:
    """Ticks are within the axis, evenly spaced, and at most as many as requested."""
    marks = ticks(low, high, 7)
    assert 1 <= len(marks) <= 7
    assert min(marks) >= low - 1e-9 and max(marks) <= high + 1e-9 * max(1.0, abs(high))
    if len(marks) > 1:
        step = marks[1] - marks[0]
        assert np.allclose(np.diff(marks), step)
        assert round(step / 10.0 ** np.floor(np.log10(step * 1.0001)), 6) in (1.0, 2.0, 5.0)


def test_a_line_breaks_at_what_is_not_finite_and_stays_on_the_canvas() -> None:
    """NaN points leave a gap; points far outside do not wrap around."""
    canvas = Canvas(60, 20)
    canvas.line([[0, 10], [20, 10], [np.nan, 10], [40, 10], [60, 10]], INK, 2.0)
    image = canvas.image()
    assert count(image[:, 22:38], INK) == 0 and count(image[:, :20], INK) > 10 < count(image[:, 42:], INK)
    outside = Canvas(60, 20)
    outside.line([[1e7, 1e7], [2e7, 1e7]], INK, 2.0)
    assert count(outside.image(), INK) == 0


def test_a_picture_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    """A missing folder is an error, which OpenCV itself ignores."""
    with pytest.raises(OSError, match="none"):
        write_png(str(tmp_path / "none" / "x.png"), Canvas(4, 4).image())
