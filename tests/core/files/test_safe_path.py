"""Paths that files name: inside their folder, by name and by link."""

import os
from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.core.files.fields import Fields
from keymark.core.files.safe_path import LONGEST, LONGEST_PART, check_links, inside_path

VALID = "a path inside the folder"


def inside(text: object, folder: Path) -> Path:
    """The path in a field."""
    return inside_path(Fields({"clip": text}, "take.json"), "clip", folder, VALID)


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
    """Whatever letters people write."""
    assert inside(text, tmp_path) == tmp_path / text


@pytest.mark.parametrize(
    "text",
    [
        *("", " ", ".", "./", "..", "../x", "a/../../x", "a\\..\\..\\x", "/x", "\\x", "C:\\x", "C:x"),
        *("\\\\server\\share\\x", "//server/x", "a\0b", "a\nb", "a\u202eb", "a\x1b[31mb", "\ud800"),
        *("x" * (LONGEST_PART + 1), "\u30c7" * 100, "x/" * LONGEST, 7, None, ["clip.mp4"]),
    ],
)
def test_any_other_path_is_refused(text: object, tmp_path: Path) -> None:
    """It climbs, begins elsewhere, cannot be seen or cannot be."""
    with pytest.raises(InputError, match=r"^take\.json: clip is"):
        inside(text, tmp_path)


def test_links_must_stay_in_one_of_the_folders(tmp_path: Path) -> None:
    """Through any number of links; what is not there is nobody's link."""
    home, other = tmp_path / "home", tmp_path / "other"
    for folder in (home, other):
        folder.mkdir()
        (folder / "file").touch()
    try:
        (home / "near").symlink_to("file")
        (home / "far").symlink_to(other / "file")
        (home / "by").symlink_to("far")
        (home / "folder").symlink_to(other)
        (tmp_path / "same").symlink_to(home)
    except OSError:
        pytest.skip("no links here")
    check_links([home / "file", home / "near", home / "none", tmp_path / "same" / "near"], [home])
    check_links([home / "far"], [home, other])
    for name in ("far", "by", "folder/file", "folder"):
        with pytest.raises(InputError, match="leads by a link to .*it must stay inside"):
            check_links([home / name], [home])


def test_a_circle_of_links_counts_as_where_it_lies(tmp_path: Path) -> None:
    """It leads nowhere, so it leads out of no folder; opening it is what fails."""
    try:
        os.symlink(tmp_path / "a", tmp_path / "a")
    except OSError:
        pytest.skip("no links here")
    check_links([tmp_path / "a"], [tmp_path])
    with pytest.raises(InputError, match="must stay inside"):
        check_links([tmp_path / "a"], [tmp_path / "elsewhere"])
    with pytest.raises(OSError):
        (tmp_path / "a").read_bytes()
