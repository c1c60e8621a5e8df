"""The sheet of a character: where the camera sees it, and over the floor from the side."""

import numpy as np
import pytest
from _synthetic_take import SIZE, write_synthetic_take
from keymark.core.arrays import Image
from keymark.core.report.canvas import Canvas
from keymark.core.report.mannequin import SIDE, CharacterFigure, character_sheet, draw_character
from keymark.core.report.pictures import GAP, MARGIN, TITLE
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

CORNERS = np.array([[x, y, z] for x in (-0.2, 0.2) for y in (-0.2, 0.2) for z in (0.0, 1.7)])
OUTWARD = np.array(
    [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
    ]
    + [[1, 5, 7], [1, 7, 3]]
)
RED = (10.0, 20.0, 230.0)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("character") / "take", 4))


def box(place: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> CharacterFigure:
    return CharacterFigure(CORNERS + np.array(place), OUTWARD, np.tile(np.array(RED), (len(OUTWARD), 1)))


def red(picture: Image) -> Image:
    return (picture[..., 2].astype(int) - picture[..., 0] > 60) & (picture[..., 1] < 90)


def test_only_what_faces_the_eye_is_drawn() -> None:
    def project(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.stack([50.0 + 50.0 * points[:, 0], 90.0 - 50.0 * points[:, 2]], axis=-1), points[:, 1]

    colors = np.zeros((len(OUTWARD), 3))
    front = (CORNERS[OUTWARD][..., 1] < 0.0).all(axis=1)
    colors[front] = RED
    for triangles, seen in ((OUTWARD, True), (OUTWARD[:, ::-1], False)):
        canvas = Canvas(100, 100)
        draw_character(canvas, CharacterFigure(CORNERS, triangles, colors), project)
        assert red(canvas.image()).any() == seen


def test_a_row_with_footage_only_where_there_is_some(take: Take) -> None:
    figures = {0: box(), 3: box((0.3, 0.0, 0.0))}
    images = {frame: np.full((SIZE[1], SIZE[0], 3), 90, dtype=np.uint8) for frame in figures}
    with_footage = character_sheet("Hero", figures, take.camera, images, 1, 0.0)
    without = character_sheet("Held", figures, take.camera, {}, 1, 0.0)
    assert with_footage.shape[0] - without.shape[0] == SIDE + GAP
    assert not red(with_footage[MARGIN + TITLE : MARGIN + TITLE + SIDE]).any()
    for column in range(2):
        left = MARGIN + column * (SIDE + GAP)
        for row in range(2):
            top = MARGIN + TITLE + row * (SIDE + GAP)
            assert red(without[top : top + SIDE, left : left + SIDE]).sum() > 500


def test_the_floor_line_lies_under_the_feet(take: Take) -> None:
    lows = []
    for height in (0.0, 0.4):
        sheet = character_sheet("Hero", {0: box((0.0, 0.0, height))}, take.camera, {}, 1, 0.0)
        tile = sheet[MARGIN + TITLE + SIDE + GAP :][:SIDE, MARGIN : MARGIN + SIDE]
        line = np.flatnonzero(np.abs(tile[:, 3].astype(int) - (140, 134, 130)).max(axis=-1) < 25)
        lows.append(int(np.flatnonzero(red(tile).any(axis=1)).max()) - int(line.max()))
    assert abs(lows[0]) <= 3 and lows[1] < -20
