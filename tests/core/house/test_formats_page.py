"""docs/formats.md agrees with the code: its limits are the readers', and every schema has its row."""

import json
import re
from pathlib import Path

import pytest
from keymark.core import MOST_PIXELS
from keymark.core.body import posture as posture_fields
from keymark.core.files import json_file, kinds
from keymark.core.footage import camera_fields
from keymark.core.footage import ignored_regions as ignored_region_fields
from keymark.core.footage.clips import image_sequence
from keymark.core.footage.keypoints import frame_folder, keypoint_file
from keymark.core.prior import library as library_file
from keymark.core.retarget import retarget_record
from keymark.core.retarget.maps import character_map as character_map_file
from keymark.core.shoot import discovery
from keymark.core.shoot import discovery as shoot
from keymark.core.take import conversion_record, conversion_settings, keyframe_file, take_file
from keymark.core.take import description as shoot_file
from keymark.core.take import motion as motion_file

MIB = 2**20
LIMITS = {
    f"{json_file.LARGEST_BYTES // MIB} MiB": "`take.json`, `keyframes.json`, `truth.json`, a list of takes",
    f"{discovery.LARGEST_BYTES // MIB} MiB": "`take.json`, `keyframes.json`, `truth.json`, a list of takes",
    f"{motion_file.LARGEST_BYTES // MIB} MiB": "`motion.json`",
    f"{library_file.LARGEST_BYTES // MIB} MiB": "a library, `conversion.json`, `retarget.json`",
    f"{conversion_record.LARGEST_BYTES // MIB} MiB": "a library, `conversion.json`, `retarget.json`",
    f"{retarget_record.LARGEST_BYTES // MIB} MiB": "a library, `conversion.json`, `retarget.json`",
    f"{keypoint_file.LARGEST_BYTES // MIB} MiB; "
    f"{frame_folder.LARGEST_FILE_BYTES // MIB} MiB": "a file of keypoints; a file of a detector's folder",
    f"{shoot_file.LARGEST_BYTES // MIB} MiB": "`shoot.json`, a line of a list, a character map",
    f"{discovery.LONGEST_LINE_BYTES // MIB} MiB": "`shoot.json`, a line of a list, a character map",
    f"{character_map_file.LARGEST_BYTES // MIB} MiB": "`shoot.json`, a line of a list, a character map",
    f"{json_file.MOST_LISTS}, {json_file.DEEPEST} levels deep": "lists and objects in a file",
    f"{kinds.LONGEST_PATH} characters; {kinds.LONGEST_NAME_BYTES} bytes": "a path; a name in it",
    f"{shoot.MOST_TAKES}": "takes of a shoot",
    f"{take_file.MOST_FRAMES}": "frames of a take",
    f"{keyframe_file.MOST_KEYFRAMES}": "keyframes of a take",
    f"{take_file.MOST_MARKERS}; "
    f"{take_file.LONGEST_MARKER_NAME} characters": "markers of a take; a marker's name",
    f"{ignored_region_fields.MOST_REGIONS}; "
    f"{ignored_region_fields.MOST_POINTS}": "ignored regions of a take; points of a stroke",
    f"{conversion_settings.MOST_KEYPOINT_FILES} ": "files of keypoints of a take",
    f"{camera_fields.LARGEST_SIDE_PX}; {MOST_PIXELS}": "width, height of a clip's pictures; pixels of one",
    f"{image_sequence.MOST_IMAGES} ": "images of a sequence",
    f"{posture_fields.FARTHEST_M:.0f} m": "distance of keyframes from the origin",
    f"{camera_fields.FARTHEST_M:.0f} m": "distance of cameras from the origin",
}


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """docs/formats.md."""
    return (repository / "docs" / "formats.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(("limit", "what"), LIMITS.items())
def test_limits_are_those_of_the_readers(page: str, limit: str, what: str) -> None:
    assert f"| {what} | {limit.strip()} |" in page


def test_every_schema_has_its_row(page: str, repository: Path) -> None:
    rows = page.split("## What is refused")[0]
    named = set(re.findall(r"\| `([a-z]+)`(?:, each line)? \|", rows))
    there = {
        path.name.removesuffix(".schema.json") for path in (repository / "presets" / "schemas").iterdir()
    }
    assert named == there


def test_editor_settings_name_existing_schemas(page: str, repository: Path) -> None:
    (example,) = re.findall(r"```json\n(.*?)```", page, flags=re.DOTALL)
    for entry in json.loads(example)["json.schemas"]:
        assert (repository / entry["url"].removeprefix("./keymark/")).is_file()
