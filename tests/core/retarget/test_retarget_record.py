"""retarget.json: what is written is read again; every mistake is one sentence."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from _characters import full_record
from keymark.core.errors import InputError
from keymark.core.files.json_file import write_readable_json
from keymark.core.retarget.retarget_record import RECORD_FILE, RetargetRecord, read_retarget_record


def written(folder: Path, record: RetargetRecord) -> RetargetRecord:
    """The record as it is read again."""
    write_readable_json(folder / RECORD_FILE, record.to_json())
    return read_retarget_record(folder)


def test_a_record_comes_back_as_it_was(tmp_path: Path) -> None:
    assert written(tmp_path, full_record()) == full_record()
    first = (tmp_path / RECORD_FILE).read_bytes()
    written(tmp_path, read_retarget_record(tmp_path))
    assert (tmp_path / RECORD_FILE).read_bytes() == first


def test_figures_have_five_digits(tmp_path: Path) -> None:
    figures = {"a_mm": 1.23456789, "b": None, "keys": 1234567}
    bare = replace(full_record(), quality=figures, map=replace(full_record().map, preset=None))
    assert written(tmp_path, bare).quality == {"a_mm": 1.2346, "b": None, "keys": 1234567}
    text = (tmp_path / RECORD_FILE).read_text(encoding="utf-8")
    assert '"keys": 1234567' in text and '"preset": null' in text


@pytest.mark.parametrize(
    ("way", "value", "said"),
    [
        (("schema_version",), 2, "newer Keymark"),
        (("character", "file"), "", "character: file is ''"),
        (("character", "sha256"), None, "sha256 is null; it must be a SHA-256 of 64 digits"),
        (("map", "origin"), "guessed", "one of given, saved, recognized"),
        (("frames",), 0, "frames is 0"),
        (("size",), 1.5e6, "size is 1500000.0"),
        (("fps",), 0, "fps is 0"),
        (("options", "legs"), "both feet", "one of fk, ik, both"),
        (("limbs", "tail"), "fk", "unknown field 'tail'"),
        (("quality", "skate_mm_per_frame"), "low", "quality: skate_mm_per_frame is 'low'"),
        (("quality",), {f"f{n}": 0 for n in range(201)}, "at most 200"),
        (("doubts",), "none", "doubts is 'none'; it must be a list"),
        (("files", "../x"), "ab" * 32, "a file of this folder"),
    ],
)
def test_every_mistake_is_named(tmp_path: Path, way: tuple[Any, ...], value: Any, said: str) -> None:
    whole = json.loads(json.dumps(full_record().to_json()))
    holder = whole
    for key in way[:-1]:
        holder = holder[key]
    holder[way[-1]] = value
    (tmp_path / RECORD_FILE).write_text(json.dumps(whole), encoding="utf-8")
    with pytest.raises(InputError, match=said) as caught:
        read_retarget_record(tmp_path)
    assert str(caught.value).startswith(str(tmp_path / RECORD_FILE))
