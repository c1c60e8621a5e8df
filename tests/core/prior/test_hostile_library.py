"""Library files from strangers: whatever is in them, one sentence or a library."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from _fuzz import changed
from _libraries import small_library
from hypothesis import HealthCheck, given, settings
from keymark.core.errors import InputError
from keymark.core.prior.library import LARGEST_BYTES, Library, read_library, write_library

VALID = small_library().to_json()
TEXT = json.dumps(VALID, ensure_ascii=False).encode()


def judged(value: Any) -> bool:
    """Whether a value is a library: where it is none, one sentence says so; where it is, it can be kept."""
    try:
        library = Library.from_json(value, "here")
    except InputError as error:
        assert len(str(error).splitlines()) == 1 and str(error).isprintable() and len(str(error)) < 1500
        return False
    again = library.to_json()
    assert Library.from_json(again, "here").to_json() == again
    json.dumps(again, allow_nan=False).encode()
    return True


@settings(max_examples=100, suppress_health_check=list(HealthCheck))
@given(changed(VALID))
def test_a_changed_library_is_one_or_says_why_not(value: Any) -> None:
    """Whatever fields hold: no other error, no second line, nothing that could not be written again."""
    judged(value)


def bomb(**fields: Any) -> bytes:
    """The valid library with some of its fields replaced, as bytes."""
    return json.dumps(VALID | fields).encode()


STEP = {"time_s": 0.0, "posture": "Stand on one leg"}
BOMBS: dict[str, Callable[[], bytes]] = {
    "deep lists": lambda: TEXT[:-1] + b', "x": ' + b"[" * 100_000,
    "deep and closed": lambda: TEXT[:-1] + b', "x": ' + b"[" * 900 + b"]" * 900 + b"}",
    "deep in a field": lambda: b'{"schema": ' + b"[" * 900 + b"]" * 900 + b"}",
    "many fields": lambda: bomb(**{f"f{n}": 0 for n in range(200_000)}),
    "many fields, one missing": lambda: json.dumps(
        {"schema": VALID["schema"]} | {f"schema_versio{n}": 0 for n in range(100_000)}
    ).encode(),
    "a long name": lambda: bomb(**{"t" * 3_000_000: 0}),
    "a long title": lambda: bomb(title="t" * 3_000_000),
    "a long identifier": lambda: bomb(identifier="a" * 3_000_000),
    "a long license": lambda: bomb(license="A" * 3_000_000),
    "many postures": lambda: bomb(postures=VALID["postures"][:1] * 2000),
    "many steps": lambda: bomb(motions=[VALID["motions"][0] | {"steps": [STEP] * 50_000}]),
    "many motions": lambda: bomb(motions=[VALID["motions"][0]] * 101),
    "many numbers": lambda: b'{"schema": [' + b"0," * 1_900_000 + b"0]}",
    "large numbers": lambda: bomb(version=0).replace(b'"version": 0', b'"version": ' + b"9" * 100_000),
    "too large": lambda: b" " * (LARGEST_BYTES + 1),
    "nothing": lambda: b"",
    "a list": lambda: b"[]",
    "another file": lambda: b'{"keyframes": []}',
}


@pytest.mark.parametrize("kind", BOMBS)
def test_what_is_meant_to_hurt_is_refused(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "bomb.json"
    path.write_bytes(BOMBS[kind]())
    with pytest.raises(InputError) as caught:
        read_library(path)
    sentence = str(caught.value)
    assert len(sentence.splitlines()) == 1 and len(sentence) < 1500 and "bomb.json" in sentence


@pytest.mark.parametrize(
    ("way", "value", "said"),
    [
        (("schema",), "keymark-motion", "keymark-library"),
        (("schema_version",), 2, "newer Keymark"),
        (("schema_version",), 0, "schema_version"),
        (("identifier",), "../up", "identifier is '../up'"),
        (("identifier",), "Walk", "lower-case"),
        (("identifier",), "auto", "not .auto."),  # names the choice among all libraries
        (("identifier",), "walk.json", "no ending .json"),  # would name a file where libraries are named
        (("title",), "\u200d", "visible characters"),
        (("motions", 1, "duration_s"), 1e-9, "from 0.001 to 600 s"),  # endless cycles between two frames
        (("titel",), "Walk", "unknown field 'titel' \\(is 'title' meant\\?\\)"),
        (("title",), None, "title is null"),
        (("title",), "a\u202eb", "control characters"),
        (("title",), "t" * 61, "at most 60"),
        (("version",), 0, "version is 0"),
        (("license",), "free!", "SPDX"),
        (("tags",), "gait", "a list of at most 30"),
        (("actor", "segments_m", "shin.L"), 5.0, "shin.L is 5.0"),
        (("actor", "segments_m", "tail"), 0.3, "'tail'"),
        (("postures",), [], "1 to 1000 postures"),
        (("postures", 1, "name"), "LEFT FOOT LANDS", "cannot be told apart"),
        (("postures", 1, "name"), "Left\u200d foot  lands", "cannot be told apart"),
        (
            ("postures", 1, "posture", "knee.L.flexion"),
            "bent",
            r"postures\[1\].posture: knee.L.flexion|knee.L.flexion is",
        ),
        (("postures", 1, "posture", "knee.L.twist"), 0.1, "unknown degree of freedom"),
        (("postures", 1, "posture", "pelvis.location_x"), 500.0, "from -100 to 100"),
        (("motions", 0, "steps", 1, "time_s"), 0.0, "later than"),
        (("motions", 0, "steps", 0, "time_s"), 0.1, "first step must be at 0"),
        (("motions", 0, "steps", 1, "posture"), "Fly", "no posture so named"),
        (("motions", 0, "duration_s"), 0.62, "must end later"),
        (("motions", 0, "cyclic"), 1, "true or false"),
        (("motions", 1, "travel"), {"x_m": 1.0, "y_m": 0.0, "heading_rad": 0.0}, "not cyclic has none"),
        (("motions", 1, "name"), "steps", "cannot be told apart"),
    ],
)
def test_every_mistake_is_named(way: tuple[Any, ...], value: Any, said: str) -> None:
    """The sentence says which value is wrong, and what would be right."""
    library = json.loads(TEXT)
    holder = library
    for key in way[:-1]:
        holder = holder[key]
    holder[way[-1]] = value
    with pytest.raises(InputError, match=said) as caught:
        Library.from_json(library, "walk.json")
    assert str(caught.value).startswith("walk.json")


def test_what_could_not_be_read_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="identifier"):
        write_library(tmp_path / "x.json", replace(small_library(), identifier="../x"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="this system has no endless file")
def test_a_file_without_end_is_not_read_to_its_end() -> None:
    """A device says that it holds nothing, and then never stops: it is not opened."""
    with pytest.raises(InputError, match="is a device, a pipe or a socket"):
        read_library(Path("/dev/zero"))
