"""`conversion.json` is read back as written, and its digest changes with every input and nothing else."""

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from _synthetic_take import edit_json, write_shoot
from keymark.core.errors import InputError
from keymark.core.take.conversion_record import (
    RECORD_FILE,
    ConversionRecord,
    conversion_digest,
    is_up_to_date,
    read_record,
    write_record,
)
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import describe, effective_settings
from keymark.core.take.evidence import UsedEvidence, UsedKeypoints

RECORD = ConversionRecord(
    digest="ab" * 16,
    keymark="1.0.0",
    take="walk",
    method="map",
    library="walking",
    frames=8,
    frame_start=1,
    fps=29.97,
    keyframes=(1, 5),
    matched=(5,),
    confidence=0.5,
    weakest=None,
    weak_frames=(3,),
    notes=("A note.", "\u00c4rger \U0001f3ac"),
    files={"motion.json": "ab" * 32, "report/overlay.png": "cd" * 32},
    evidence=UsedEvidence(
        ("trunk",), (UsedKeypoints("a detector", ("nose", "wrist.L"), 0.97, 0.1),), False, True
    ),
    libraries={"walking": "ef" * 16},
    doubtful=(5,),
)


def made(folder: Path, record: ConversionRecord = RECORD) -> Path:
    for name in record.files:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    write_record(folder, record)
    return folder


def test_a_record_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    made(tmp_path)
    assert read_record(tmp_path) == RECORD
    before = (tmp_path / RECORD_FILE).read_bytes()
    write_record(tmp_path, read_record(tmp_path))
    assert (tmp_path / RECORD_FILE).read_bytes() == before


def test_a_result_is_up_to_date_with_its_digest_and_all_its_files(tmp_path: Path) -> None:
    made(tmp_path)
    assert is_up_to_date(tmp_path, RECORD.digest)
    assert not is_up_to_date(tmp_path, "cd" * 16)
    (tmp_path / "report" / "overlay.png").unlink()
    assert not is_up_to_date(tmp_path, RECORD.digest)
    assert not is_up_to_date(tmp_path / "none", RECORD.digest)


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff", b'{"schema_version": 1}'])
def test_a_result_with_a_damaged_record_is_not_up_to_date(content: bytes, tmp_path: Path) -> None:
    made(tmp_path)
    (tmp_path / RECORD_FILE).write_bytes(content)
    assert not is_up_to_date(tmp_path, RECORD.digest)


MISTAKES: list[tuple[Callable[[dict[str, Any]], object], str]] = [
    (lambda v: v.update(schema_version=2), "version is 2, made by a newer Keymark; this one reads up to 1"),
    (lambda v: v.pop("digest"), "digest is missing"),
    (lambda v: v.update(take="x" * 2000), "take is 'xxx"),
    (lambda v: v.update(frames=0), "frames is 0"),
    (lambda v: v.update(fps=0), "fps is 0"),
    (lambda v: v.update(keyframes=[1.5]), r"keyframes\[0\] is 1.5; it must be a whole number from"),
    (lambda v: v.update(keyframes=[True]), r"keyframes\[0\] is True; it must be a whole number from"),
    (
        lambda v: v.update(weak_frames=[10**9]),
        r"weak_frames\[0\] is 1000000000; it must be a whole number from",
    ),
    (lambda v: v.update(confidence=1.1), "confidence is 1.1; it must be a number from 0 to 1"),
    (lambda v: v.update(notes=["x" * 20_000]), r"notes\[0\] is .*; it must be a text of at most 10000"),
    (lambda v: v.update(notes="x"), "notes is 'x'"),
    (lambda v: v.update(files={"../up": "ab" * 32}), r"'\.\./up'; it must be a file of this folder"),
    (lambda v: v.update(files={"/up": "ab" * 32}), "'/up'"),
    (lambda v: v.update(files={"a": "ab"}), "it must be a SHA-256"),
    (lambda v: v.update(files={"a": None}), "it must be a SHA-256"),
    (
        lambda v: v.update(files={f"{n}": "ab" * 32 for n in range(200)}),
        "files has 200 digests of files; at most 100 are read",
    ),
    (lambda v: v.update(doubtful="5"), "doubtful is '5'; it must be a list of"),
    (lambda v: v.update(libraries=["walking"]), r"libraries is \['walking'\]; it must be an object"),
    (lambda v: v.update(doubtful=["5"]), r"doubtful\[0\] is '5'; it must be a whole number from"),
    (lambda v: v.update(libraries={"walking": 7}), "libraries: walking is 7; it must be a text"),
    (lambda v: v.update(evidence=[]), "evidence is .*; it must be an object"),
    (
        lambda v: v["evidence"].update(markers=["x" * 300]),
        r"evidence: markers\[0\] is \'xxx.*; it must be a text of at most 200",
    ),
    (lambda v: v["evidence"].update(contours=1), "evidence: contours is 1; it must be true or false"),
    (
        lambda v: v["evidence"].update(keypoints=[1]),
        r"evidence: keypoints\[0\] is 1; it must be an object with source, points, believed",
    ),
    (
        lambda v: v["evidence"]["keypoints"][0].update(points=["tail"]),
        r"keypoints\[0\]: points\[0\] is 'tail'; it must be one of head, ",
    ),
    (lambda v: v["evidence"]["keypoints"][0].update(believed=2), r"keypoints\[0\]: believed is 2"),
    (lambda v: v["evidence"]["keypoints"][0].pop("swapped"), r"keypoints\[0\]: swapped is missing"),
]


@pytest.mark.parametrize(("change", "said"), MISTAKES)
def test_a_mistake_is_named(change: Callable[[dict[str, Any]], object], said: str, tmp_path: Path) -> None:
    made(tmp_path)
    edit_json(tmp_path / RECORD_FILE, change)
    with pytest.raises(InputError, match=said) as caught:
        read_record(tmp_path)
    assert str(caught.value).startswith(str(tmp_path / RECORD_FILE))


def test_a_record_of_an_earlier_keymark_can_be_read(tmp_path: Path) -> None:
    made(tmp_path)
    edit_json(tmp_path / RECORD_FILE, lambda value: [value.pop(name) for name in ("libraries", "doubtful")])
    assert read_record(tmp_path) == replace(RECORD, libraries={}, doubtful=())


def test_what_is_written_can_be_read(tmp_path: Path) -> None:
    bare = replace(RECORD, library=None, confidence=None, notes=(), files={}, keyframes=(), matched=())
    for evidence in (UsedEvidence(), None):
        record = replace(bare, evidence=evidence)
        assert read_record(made(tmp_path, record)) == record


def test_evidence_is_told_in_words() -> None:
    sources = (UsedKeypoints("a", ("nose",), 1.0), UsedKeypoints("b", ("nose", "wrist.L"), 0.5))
    assert (
        UsedEvidence(("trunk",), sources, True, True).words == "1 marker, 3 keypoints, depth hints, contours"
    )
    assert UsedEvidence(contours=True).words == "contours"
    astray = (UsedKeypoints("a", ("nose",), 0.0),)
    assert UsedEvidence(("trunk",), astray).words == "1 marker"
    assert UsedEvidence().words == "keyframes alone"


@pytest.fixture
def shoot(tmp_path: Path) -> Path:
    return write_shoot(tmp_path / "shoot", takes=1, frames=3)


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


def edit(name: str, **fields: Any) -> Callable[[Path], Path]:
    """Change fields of one of the shoot's files, which may be new."""
    return lambda shoot: edit_json(shoot / name, **fields)


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
    edit("shoot.json", character={"file": "anna.blend", "legs": "ik", "map": None, "//": "x"})(shoot)
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
