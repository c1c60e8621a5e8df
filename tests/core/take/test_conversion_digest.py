"""The digest of a conversion's input: it changes with every input, and with nothing else."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from _shoot import write_shoot
from keymark.core.take.conversion_digest import conversion_digest
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import describe, effective_settings


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_shoot(tmp_path_factory.mktemp("digests") / "shoot", takes=1, frames=3)


@pytest.fixture
def shoot(pristine: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pristine, tmp_path / "shoot"))


def digest(
    shoot: Path,
    libraries: tuple[str, ...] = (),
    version: str = "1",
    maps: tuple[str, ...] = (),
    **chosen: Any,
) -> str:
    description = describe(shoot / "day1" / "take01.mp4")
    settings = effective_settings(description, ConversionSettings(**chosen))
    return conversion_digest(description, settings, libraries, shoot.parent / "out", version, maps)


def edit(name: str, **fields: Any) -> Callable[[Path], None]:
    """Change fields of one of the shoot's files, which may be new."""

    def change(shoot: Path) -> None:
        file = shoot / name
        value = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        file.write_text(json.dumps({**value, **fields}), encoding="utf-8")

    return change


def lengthen(shoot: Path) -> None:
    with (shoot / "day1" / "take01.mp4").open("ab") as clip:
        clip.write(b"\0")


def _turned_round(shoot: Path) -> dict[str, Any]:
    """Reorder the shoot's markers, and so the results."""
    markers = json.loads((shoot / "shoot.json").read_text(encoding="utf-8"))["markers"]
    return dict(reversed(markers.items()))


@pytest.mark.parametrize(
    "change",
    [
        edit("day1/take01.keyframes.json", more=1),
        lambda shoot: (shoot / "day1" / "take01.keyframes.json").unlink(),
        edit("shoot.json", actor={"height_m": 1.6}),
        edit("shoot.json", method="ekf"),
        edit("shoot.json", pictures=True),
        lambda shoot: edit("shoot.json", markers=_turned_round(shoot))(shoot),
        edit("day1/shoot.json", fps=25),
        edit("day1/take01.take.json", frame_start=7),
        edit("day1/take01.take.json", ignored_regions=[{"box": [1, 2, 3, 4]}]),
        lengthen,
    ],
)
def test_a_changed_input_changes_the_digest(change: Callable[[Path], Any], shoot: Path) -> None:
    before = digest(shoot)
    change(shoot)
    assert digest(shoot) != before


def test_settings_libraries_and_version_change_the_digest(shoot: Path) -> None:
    digests = [
        digest(shoot),
        digest(shoot, version="2"),
        digest(shoot, libraries=("a",)),
        digest(shoot, libraries=("a", "b")),
        digest(shoot, libraries=("a",), floor_m=0.1),
        digest(shoot, library="auto", libraries=("a", "b")),
        digest(shoot, library="auto", libraries=("a",)),
    ]
    assert len(set(digests)) == len(digests)


def test_times_comments_and_other_files_do_not_change_it(shoot: Path) -> None:
    before = digest(shoot)
    for file in shoot.rglob("*.*"):
        os.utime(file, (1e9, 1e9))
    edit("shoot.json", **{"// why": "a comment"})(shoot)
    (shoot / "day1" / "take02.mp4").touch()
    assert digest(shoot) == before


def test_fields_without_effect_do_not_change_it(shoot: Path) -> None:
    edit("shoot.json", method=None, pictures=None)(shoot)
    before = digest(shoot)
    assert digest(shoot, method="map", pictures=True, floor_m=0.1) == before
    edit("shoot.json", method="map", floor_m=0.5)(shoot)
    edit("day1/take01.take.json", **{"$schema": "take.schema.json", "schema_version": 1})(shoot)
    assert digest(shoot) == before


def test_a_character_counts_by_content_map_and_options(shoot: Path) -> None:
    before = digest(shoot)
    assert digest(shoot, maps=("a",)) == before
    (shoot / "anna.blend").write_bytes(b"BLENDER")
    digests = [before]
    for character in (
        {"file": "anna.blend"},
        {"file": "anna.blend", "object": "rig"},
        {"file": "anna.blend", "legs": "fk"},
        {"file": "anna.blend", "tolerance_mm": 0},
    ):
        edit("shoot.json", character=character)(shoot)
        digests.append(digest(shoot))
    edit("shoot.json", character={"file": "anna.blend"})(shoot)
    digests += [digest(shoot, maps=("a",)), digest(shoot, maps=("a", "b"))]
    (shoot / "anna.blend").write_bytes(b"BLENDER2")
    digests.append(digest(shoot))
    assert len(set(digests)) == len(digests)
    edit("shoot.json", character={"file": "anna.blend", "legs": "both", "map": None, "//": "x"})(shoot)
    assert digest(shoot) == digests[-1]


def test_the_buffers_of_a_gltf_count(shoot: Path) -> None:
    uris = ["anna.bin", "data:application/octet-stream;base64,AAAA", "../out.bin", 3]
    gltf = {"asset": {"version": "2.0"}, "buffers": [{"uri": uri} for uri in uris]}
    (shoot / "anna.gltf").write_text(json.dumps(gltf), encoding="utf-8")
    (shoot / "anna.bin").write_bytes(b"1")
    edit("shoot.json", character={"file": "anna.gltf"})(shoot)
    before = digest(shoot)
    (shoot / "anna.bin").write_bytes(b"2")
    assert digest(shoot) != before
