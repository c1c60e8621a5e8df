"""Fields inherited from several files, each with its source; paths in fields that stay in their folder."""

import os
from dataclasses import make_dataclass
from pathlib import Path
from typing import Annotated, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.files.fields import ALTERNATIVES, Fields, InheritedFields, child_location
from keymark.core.files.kinds import LONGEST_NAME_BYTES, LONGEST_PATH, Number, safe_path
from keymark.core.files.paths import check_symlinks
from keymark.core.files.records import Record, read_record

FAR, NEAR = "/shoot/shoot.json", "/shoot/take/take.json"


def merged(*patches: dict[str, Any]) -> InheritedFields:
    """Objects merged over each other, the farthest first, from `0.json`, `1.json` and so on."""
    fields = InheritedFields()
    for index, patch in enumerate(patches):
        fields = fields.overridden_by(patch, f"{index}.json")
    return fields


def test_the_nearer_field_counts_and_objects_are_merged() -> None:
    far = {"fps": 24, "camera": {"lens_mm": 35.0, "resolution": [640, 480]}}
    fields = merged(far, {"fps": 30, "camera": {"resolution": [320, 240]}})
    assert fields == {"fps": 30, "camera": {"lens_mm": 35.0, "resolution": [320, 240]}}
    assert fields.sources == {"fps": "1.json", "camera": "1.json"}
    assert fields["camera"].sources == {"lens_mm": "0.json: camera", "resolution": "1.json: camera"}


PAIRS = [
    (one, other)
    for groups in ALTERNATIVES
    for group in groups
    for others in groups
    if others != group
    for one in group
    for other in others
]


@pytest.mark.parametrize("pair", PAIRS)
def test_of_two_ways_to_say_one_thing_the_nearer_counts(pair: tuple[str, str]) -> None:
    one, other = pair
    assert merged({one: 1}, {other: 2}) == {other: 2}
    assert merged({one: 1}, {one: 3, other: 2}) == {one: 3, other: 2}
    assert merged({one: 1}, {other: None}) == {one: 1, other: None}
    assert merged({"actor": {one: 1}}, {"actor": {other: 2}}) == {"actor": {other: 2}}


def test_comments_are_left_out_at_any_level() -> None:
    assert merged({"//": 1, "camera": {"// lens": "?", "lens_mm": 1}}) == {"camera": {"lens_mm": 1}}


@pytest.mark.parametrize(
    ("field", "said"),
    [
        ("lens_mm", rf"^{FAR}: camera: lens_mm is -1"),
        ("sensor_width_mm", rf"^{NEAR}: camera: sensor_width_mm is 'x'"),
        ("shift_x", rf"^{NEAR}: camera: shift_x is missing"),
    ],
)
def test_a_sentence_names_the_file_that_says_the_field(field: str, said: str) -> None:
    fields = InheritedFields().overridden_by({"camera": {"lens_mm": -1}}, FAR)
    fields = fields.overridden_by({"camera": {"sensor_width_mm": "x"}}, NEAR)
    camera = make_dataclass("Camera", [(field, Annotated[float, Number(0.0, 1.0)])], bases=(Record,))
    shot = make_dataclass("Shot", [("camera", camera)], bases=(Record,))
    with pytest.raises(InputError, match=said):
        read_record(shot, Fields(fields, NEAR))


def test_locations_of_objects_read_well() -> None:
    assert child_location("a.json", "camera") == "a.json: camera"
    assert child_location("a.json: camera", "lens") == "a.json: camera.lens"
    assert child_location("takes.jsonl, line 3", "camera") == "takes.jsonl, line 3: camera"


VALUES = st.recursive(
    st.none() | st.integers(0, 3) | st.lists(st.integers(0, 1), max_size=2),
    lambda inner: st.dictionaries(st.sampled_from("abc"), inner, max_size=3),
    max_leaves=6,
)
OBJECTS = st.dictionaries(st.sampled_from("abc"), VALUES, max_size=3)


def merge_patch(target: Any, patch: Any) -> Any:
    """JSON Merge Patch as RFC 7396 writes it, section 2."""
    if not isinstance(patch, dict):
        return patch
    result = dict(target) if isinstance(target, dict) else {}
    for name, value in patch.items():
        if value is None:
            result.pop(name, None)
        else:
            result[name] = merge_patch(result.get(name), value)
    return result


def without_nulls(value: Any) -> Any:
    """A value whose objects have no fields that are null."""
    if not isinstance(value, dict):
        return value
    return {name: without_nulls(item) for name, item in value.items() if item is not None}


@given(st.lists(OBJECTS, max_size=4))
def test_merging_is_that_of_a_merge_patch(patches: list[dict[str, Any]]) -> None:
    expected: Any = {}
    for patch in patches:
        expected = merge_patch(expected, patch)
    assert without_nulls(merged(*patches)) == expected


VALID = "a path inside the folder"


def inside(text: object, folder: Path) -> Path:
    return safe_path(Fields({"clip": text}, "take.json"), "clip", folder, VALID)


@pytest.mark.parametrize(
    "text",
    [
        "clip.mp4",
        "a/b/clip.mp4",
        "./clip.mp4",
        "a\u3000b.mp4",
        "\u30c7\u30e2.mp4",
        "50 %.mp4",
        "a..b",
        "...",
        "-i",
    ],
)
def test_a_path_inside_is_taken(text: str, tmp_path: Path) -> None:
    assert inside(text, tmp_path) == tmp_path / text


@pytest.mark.parametrize(
    "text",
    [
        *("", " ", ".", "./", "..", "../x", "a/../../x", "a\\..\\..\\x", "/x", "\\x", "C:\\x", "C:x"),
        *("\\\\server\\share\\x", "//server/x", "a\0b", "a\nb", "a\u202eb", "a\x1b[31mb", "\ud800"),
        *("x" * (LONGEST_NAME_BYTES + 1), "\u30c7" * 100, "x/" * LONGEST_PATH, 7, None, ["clip.mp4"]),
    ],
)
def test_any_other_path_is_refused(text: object, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^take\.json: clip is"):
        inside(text, tmp_path)


def test_links_must_stay_in_one_of_the_folders(tmp_path: Path) -> None:
    root, other = tmp_path / "root", tmp_path / "other"
    for folder in (root, other):
        folder.mkdir()
        (folder / "file").touch()
    try:
        (root / "near").symlink_to("file")
        (root / "far").symlink_to(other / "file")
        (root / "by").symlink_to("far")
        (root / "folder").symlink_to(other)
        (tmp_path / "same").symlink_to(root)
    except OSError:
        pytest.skip("no links here")
    check_symlinks([root / "file", root / "near", root / "none", tmp_path / "same" / "near"], [root])
    check_symlinks([root / "far"], [root, other])
    for name in ("far", "by", "folder/file", "folder"):
        with pytest.raises(InputError, match="leads by a link to .*it must stay inside"):
            check_symlinks([root / name], [root])


def test_a_circle_of_links_is_accepted(tmp_path: Path) -> None:
    try:
        os.symlink(tmp_path / "a", tmp_path / "a")
    except OSError:
        pytest.skip("no links here")
    check_symlinks([tmp_path / "a"], [tmp_path])
