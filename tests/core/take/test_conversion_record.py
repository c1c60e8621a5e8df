"""`conversion.json`: read back as written, and refused where it is damaged."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from keymark.core.errors import InputError
from keymark.core.take.conversion_record import (
    RECORD_FILE,
    ConversionRecord,
    is_up_to_date,
    read_record,
    write_record,
)
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
    value = json.loads((tmp_path / RECORD_FILE).read_text(encoding="utf-8"))
    change(value)
    (tmp_path / RECORD_FILE).write_text(json.dumps(value), encoding="utf-8")
    with pytest.raises(InputError, match=said) as caught:
        read_record(tmp_path)
    assert str(caught.value).startswith(str(tmp_path / RECORD_FILE))


def test_a_record_of_an_earlier_keymark_can_be_read(tmp_path: Path) -> None:
    made(tmp_path)
    value = json.loads((tmp_path / RECORD_FILE).read_text(encoding="utf-8"))
    del value["libraries"], value["doubtful"]
    (tmp_path / RECORD_FILE).write_text(json.dumps(value), encoding="utf-8")
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
