"""docs/keypoint_format.md agrees with the code: fields, layouts, names, limits, and its example."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from keymark.core.footage.keypoints import detected_frames, frame_folder, keypoint_file
from keymark.core.footage.keypoints import frame_folder as frame_numbers
from keymark.core.footage.keypoints.keypoint_file import read_keypoints
from keymark.core.footage.keypoints.keypoints import BODY_POINTS
from keymark.core.footage.keypoints.layouts import LAYOUTS

MIB = 2**20
LIMITS = {
    "a file": f"{keypoint_file.LARGEST_BYTES // MIB} MiB",
    "a file of a detector's folder": f"{frame_folder.LARGEST_FILE_BYTES // MIB} MiB",
    "frames; numbered files of a folder": f"{frame_numbers.MOST_FRAMES}",
    "people in a frame": f"{detected_frames.MOST_PEOPLE}",
    "points of all people in all frames": f"{detected_frames.MOST_POINTS}",
    "distance of a point from the picture's corner; of a guess from the hips": (
        f"{detected_frames.FARTHEST_PX:g} px; {detected_frames.FARTHEST_M:g} m"
    ),
}


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "keypoint_format.md").read_text(encoding="utf-8")


def test_every_field_is_described(page: str, repository: Path) -> None:
    schema = json.loads((repository / "presets/schemas/keypoints.schema.json").read_text(encoding="utf-8"))
    table = page.split("## Keymark's own file")[1].split("Other fields")[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, flags=re.MULTILINE)) == set(schema["properties"])


def test_every_layout_has_its_row(page: str) -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| (\d+) \|", page, flags=re.MULTILINE))
    assert rows == {name: str(layout.count) for name, layout in LAYOUTS.items()}


def test_every_body_point_is_named(page: str) -> None:
    sentence = page.split("The names are")[1].split("The same name")[0]
    assert set(re.findall(r"`(\w+)`", sentence)) == {name.partition(".")[0] for name in BODY_POINTS}


@pytest.mark.parametrize(("what", "limit"), LIMITS.items())
def test_limits_are_those_of_the_readers(page: str, what: str, limit: str) -> None:
    assert f"| {what} | {limit} |" in page


def test_the_example_is_read(page: str, tmp_path: Path) -> None:
    (example,) = re.findall(r"```json\n(.*?)```", page, flags=re.DOTALL)
    (tmp_path / "keypoints.json").write_text(example, encoding="utf-8")
    people = read_keypoints(tmp_path / "keypoints.json", 3, (1280, 720), 30.0, 1)
    assert [len(frame.pixel) for frame in people.frames] == [1, 0, 1] and people.notes == ()
    np.testing.assert_array_equal(people.frames[2].pixel[0], [[655.9, 601.3], [np.nan, np.nan]])
    assert people.frames[0].hint_m[0, 1].tolist() == [0.01, 0.88, -0.08]
