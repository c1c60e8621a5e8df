"""Pictures of a result: drawn at the right pixels, and without errors for any motion."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from _performances import made_up_keypoints
from _synthetic_take import BODY, CAMERA, SIZE, true_postures, write_synthetic_take
from keymark.core.camera.camera import Camera
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.report.canvas import INK, LEFT, RIGHT, Canvas, write_png
from keymark.core.report.pictures import (
    CELL_WIDTH,
    OUTLINE,
    SOURCE_COLORS,
    THROWN_OUT,
    evenly_spaced_frames,
    overlay_sheet,
    side_sheet,
    write_pictures,
)
from keymark.core.take.conversion_record import PICTURES
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.core.terms.contours import ContourModel
from keymark.core.video.album import Glimpses

FRAMES = 20
CAMERA_AHEAD = Camera.from_dict(CAMERA)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("report") / "take", FRAMES))


@pytest.fixture
def motion() -> Motion:
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
    return int((np.abs(image.astype(int) - color).max(axis=-1) <= tolerance).sum())


def test_all_pictures_are_written(take: Take, motion: Motion, tracks: RegionTracks, tmp_path: Path) -> None:
    files = write_pictures(tmp_path / "report", take, motion, tracks)
    assert [file.name for file in files] == list(PICTURES)
    for file in files:
        image = cv2.imread(str(file))
        assert image is not None and image.std() > 5.0


def test_large_frames_are_kept_no_larger_than_drawn(
    take: Take, motion: Motion, tracks: RegionTracks, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    images = tmp_path / "images"
    images.mkdir()
    for index in range(2):
        cv2.imwrite(str(images / f"{index:04d}.jpg"), np.full((2880, 5120, 3), 90, dtype=np.uint8))
    sizes = []

    def sheet(*given: object) -> np.ndarray:
        sizes.extend(image.shape[:2] for image in given[3].values())
        return np.zeros((8, 8, 3), dtype=np.uint8)

    monkeypatch.setattr("keymark.core.report.pictures.overlay_sheet", sheet)
    write_pictures(tmp_path / "report", replace(take, clip=images), motion, tracks)
    assert sizes and set(sizes) == {(450, 800)}


def test_what_was_kept_of_the_clip_is_shown_without_decoding_it_again(
    take: Take, motion: Motion, tracks: RegionTracks, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    glimpses = Glimpses(1.0, {frame: np.zeros(0, dtype=np.uint8) for frame in (3, 9)})
    picture = np.zeros((2 * SIZE[1], 2 * SIZE[0], 3), dtype=np.uint8)
    picture[:, 200:] = 250
    for frame in (3, 9):
        glimpses.add(frame, picture)
    turned = np.tile(np.eye(3), (FRAMES, 1, 1))
    turned[9, 0, 2] = 40.0  # what the steady camera shows lies so far to the right in the clip [px]
    given: list[dict[int, np.ndarray]] = []

    def drawn(*arguments: object) -> np.ndarray:
        given.append(arguments[3])  # type: ignore[arg-type]
        return np.zeros((8, 8, 3), dtype=np.uint8)

    monkeypatch.setattr("keymark.core.report.pictures.overlay_sheet", drawn)
    reading = Reading(tracks, glimpses=glimpses, steady=turned)
    missing = replace(take, clip=tmp_path / "gone.mp4")
    write_pictures(tmp_path / "report", missing, motion, tracks, reading=reading)
    (shown,) = given
    edges = {frame: int((image[50, :, 0] > 128).argmax()) for frame, image in shown.items()}
    assert list(shown) == [3, 9] and edges[3] - edges[9] == pytest.approx(40.0, abs=1.0)


def test_the_skeleton_lies_on_the_projected_joints(take: Take, motion: Motion, tracks: RegionTracks) -> None:
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
    plain = np.full((SIZE[1], SIZE[0], 3), 128, dtype=np.uint8)
    contours = ContourModel.average(BODY, take.camera)
    bare = RegionTracks.unmarked(tracks.time_s, SIZE)
    unmarked = replace(take, markers=())
    drawn = overlay_sheet(unmarked, motion, bare, {0: plain}, contours=contours)
    assert count(drawn, OUTLINE, 40) > 100
    marked = overlay_sheet(take, motion, tracks, {0: plain}, contours=contours)
    assert count(marked, OUTLINE, 40) < 20


def test_the_side_shows_depth(motion: Motion) -> None:
    names = BODY.skeleton.dof_names
    spans = {}
    for turn in (-np.pi / 2, 0.0):
        vector = np.zeros((FRAMES, len(names)))
        vector[:, names.index("shoulder.L.rotation_z")] = turn
        vector[:, names.index("shoulder.R.rotation_y")] = -np.pi / 2
        posture = type(motion.posture).from_vector(BODY.skeleton, vector)
        reaching = replace(motion, posture=posture, points=BODY.points(BODY.pose(posture)))
        image = side_sheet(reaching, CAMERA_AHEAD, [5])
        drawn = np.argwhere(np.abs(image[52:260].astype(int) - LEFT).max(axis=-1) <= 12)
        upper = drawn[drawn[:, 0] < 105]
        spans[turn] = float(np.ptp(upper[:, 1])) if len(upper) else 0.0
    assert spans[-np.pi / 2] > 1.5 * spans[0.0]


@pytest.mark.parametrize("pitch", [-90.0, 90.0])
def test_a_camera_that_looks_straight_down_or_up_is_seen_from_the_side(motion: Motion, pitch: float) -> None:
    turn = np.radians(90.0 + pitch)
    matrix = np.eye(4)
    matrix[1:3, 1:3] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
    camera = Camera.from_dict({**CAMERA, "matrix_world": matrix.tolist()})
    assert count(side_sheet(motion, camera, [0, 5]), LEFT) > 50


@pytest.mark.parametrize(("frame_count", "shown"), [(1, 1), (2, 2), (12, 12), (118, 12)])
def test_frames_shown_are_spread_from_first_to_last(frame_count: int, shown: int) -> None:
    frames = evenly_spaced_frames(frame_count)
    assert len(frames) == shown and frames[0] == 0 and frames[-1] == frame_count - 1
    assert len(set(np.diff(frames))) <= 2


def test_a_line_breaks_at_what_is_not_finite_and_stays_on_the_canvas() -> None:
    canvas = Canvas(60, 20)
    canvas.line([[0, 10], [20, 10], [np.nan, 10], [40, 10], [60, 10]], INK, 2.0)
    image = canvas.image()
    assert count(image[:, 22:38], INK) == 0 and count(image[:, :20], INK) > 10 < count(image[:, 42:], INK)
    outside = Canvas(60, 20)
    outside.line([[1e7, 1e7], [2e7, 1e7]], INK, 2.0)
    assert count(outside.image(), INK) == 0


def test_a_picture_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="none"):
        write_png(str(tmp_path / "none" / "x.png"), Canvas(4, 4).image())
