"""What a listing among Blender's extensions asks for, and what its reviewers search the code for."""

import ast
import re
import struct
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

LONGEST = 64
HEAVIEST_KB = 500.0
PICTURE = re.compile(r"!\[[^\]]+\]\((pictures/[^)]+)\)")
PLACES = re.compile(r"(?:^|[\s'\"])(?:/(?:home|root|usr|tmp|var|opt)/|[A-Za-z]:\\\\?Users)")
BUNDLED = {"opencv-python-headless": "OpenCV", "scipy": "SciPy", "threadpoolctl": "threadpoolctl"}
BUNDLED |= {"c3d": "c3d"}


@pytest.fixture(scope="module")
def manifest(repository: Path) -> dict[str, object]:
    """The manifest."""
    return tomllib.loads((repository / "blender_manifest.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def listing(repository: Path) -> str:
    """The listing's page."""
    return (repository / "docs" / "listing.md").read_text(encoding="utf-8")


def modules(repository: Path) -> Iterator[tuple[Path, ast.Module]]:
    """Every module of the package, by its path in the repository."""
    for room in ("core", "operators"):
        for file in sorted((repository / room).rglob("*.py")):
            yield file.relative_to(repository), ast.parse(file.read_text(encoding="utf-8"))


def test_no_field_is_empty_and_the_version_has_three_numbers(manifest: dict[str, object]) -> None:
    assert [name for name, value in manifest.items() if not value] == []
    assert manifest["schema_version"] == "1.0.0" and manifest["type"] == "add-on"
    for name in ("version", "blender_version_min"):
        assert re.fullmatch(r"\d+\.\d+\.\d+", str(manifest[name]))


def test_short_texts_are_short_and_end_without_a_stop(manifest: dict[str, object]) -> None:
    texts = [manifest["tagline"], *manifest["permissions"].values()]  # type: ignore[attr-defined]
    assert all(0 < len(text) <= LONGEST and text[-1].isalnum() for text in texts)


def test_the_name_is_our_own(manifest: dict[str, object]) -> None:
    assert "blender" not in f"{manifest['name']} {manifest['id']} {manifest['tagline']}".lower()


def test_the_license_is_blenders_and_whole(repository: Path, manifest: dict[str, object]) -> None:
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    text = (repository / "LICENSE").read_text(encoding="utf-8")
    assert "GNU GENERAL PUBLIC LICENSE" in text and "END OF TERMS AND CONDITIONS" in text


def test_whose_work_is_bundled_is_said(repository: Path, manifest: dict[str, object]) -> None:
    lines = manifest["copyright"]
    assert isinstance(lines, list)
    assert all(re.match(r"\d{4}(-\d{4})? \S", line) for line in lines)
    wheels = (repository / "tools" / "package" / "wheels.py").read_text(encoding="utf-8")
    assert all(f'"{distribution}"' in wheels for distribution in BUNDLED)
    assert [name for name in BUNDLED.values() if not any(name in line for line in lines)] == []


def test_the_icon_has_its_size(repository: Path) -> None:
    data = (repository / "docs" / "pictures" / "listing_icon.png").read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == (256, 256)


def test_the_featured_image_has_its_size(repository: Path) -> None:
    data = (repository / "docs" / "pictures" / "listing_featured.jpg").read_bytes()
    frame = re.search(rb"\xff[\xc0\xc2]\x00\x11\x08(....)", data, flags=re.DOTALL)
    assert frame is not None
    assert struct.unpack(">HH", frame[1]) == (1080, 1920)


def test_the_listings_pictures_are_there_and_light(repository: Path, listing: str) -> None:
    pictures = [repository / "docs" / name for name in PICTURE.findall(listing)]
    assert len(pictures) >= 5
    assert {picture.suffix for picture in pictures} <= {".png", ".jpg"}
    assert [picture.name for picture in pictures if not picture.is_file()] == []
    assert all(picture.stat().st_size / 1e3 <= HEAVIEST_KB for picture in pictures)


def test_the_listing_has_no_surprises(listing: str) -> None:
    for word in ("**Files**", "**Network**: none", "**Other programs**"):
        assert word in listing


def test_only_the_command_line_prints(repository: Path) -> None:
    printing = {
        path.as_posix()
        for path, tree in modules(repository)
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print"
    }
    assert printing and all(name.startswith("operators/cli/") for name in printing)


def test_no_place_on_a_machine_is_named(repository: Path) -> None:
    found = [
        f"{path}:{node.lineno} {node.value[:60]}"
        for path, tree in modules(repository)
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and PLACES.search(node.value)
    ]
    assert found == []
    assert PLACES.search("'/home/me/clip.mp4'") and PLACES.search("C:\\Users\\me")


def test_the_page_names_every_zip_and_tests_that_exist(repository: Path) -> None:
    page = (repository / "docs" / "releasing.md").read_text(encoding="utf-8")
    builds = (repository / "tools" / "package" / "builds.py").read_text(encoding="utf-8")
    series = re.findall(r'Series\("([^"]+)"', builds)
    assert len(series) == 3
    assert [name for name in series if f"| `{name}` |" not in page] == []
    tests = {Path(name).name for name in re.findall(r"`([\w/]*test_\w+\.py)`", page)}
    there = {file.name for file in (repository / "tests").rglob("test_*.py")}
    assert "test_listing.py" in tests and tests <= there
