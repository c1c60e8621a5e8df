"""Relative paths in fields: inside their folder, by name and by symbolic link."""

import os
from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.core.files.fields import Fields
from keymark.core.files.kinds import LONGEST_NAME_BYTES, LONGEST_PATH, safe_path
from keymark.core.files.paths import check_symlinks

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
