"""Library files: nothing lost, nothing trusted."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _fuzz import changed, libraries
from _libraries import small_library
from hypothesis import HealthCheck, given, settings
from keymark.core.errors import InputError
from keymark.core.prior.library import Library, read_library, write_library


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "small_steps.json"
    write_library(path, small_library())
    return path


def assert_same(first: Library, second: Library, tolerance: float) -> None:
    """Both hold the same, numbers within a tolerance."""
    for name in ("identifier", "title", "version", "author", "license", "description", "sources", "tags"):
        assert getattr(first, name) == getattr(second, name)
    assert first.actor.segments_m == pytest.approx(dict(second.actor.segments_m), abs=tolerance)
    for one, other in zip(first.postures, second.postures, strict=True):
        assert (one.name, one.tags) == (other.name, other.tags)
        np.testing.assert_allclose(one.posture.translation, other.posture.translation, atol=tolerance)
        np.testing.assert_allclose(one.posture.rotations, other.posture.rotations, atol=4.0 * tolerance)
        np.testing.assert_allclose(one.posture.angles, other.posture.angles, atol=tolerance)
    for mine, theirs in zip(first.motions, second.motions, strict=True):
        assert (mine.name, mine.cyclic) == (theirs.name, theirs.cyclic)
        assert [step.posture for step in mine.steps] == [step.posture for step in theirs.steps]
        times = [step.time_s for step in theirs.steps]
        assert [step.time_s for step in mine.steps] == pytest.approx(times, abs=tolerance)
        assert (*mine.travel, mine.duration_s) == pytest.approx(
            (*theirs.travel, theirs.duration_s), abs=tolerance
        )


@settings(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(libraries())
def test_nothing_is_lost_and_the_second_time_nothing_changes(library: Library) -> None:
    """What is written is read back to nine decimals, and from then on to the last bit."""
    value = library.to_json()
    back = Library.from_json(value, "here")
    assert_same(back, library, 3e-9)  # half a turn is kept two nanoradians short
    assert back.to_json() == value
    assert_same(Library.from_json(back.to_json(), "here"), back, 0.0)


def test_a_way_too_short_for_the_file_leaves_none() -> None:
    library = small_library()
    cycle = next(motion for motion in library.motions if motion.cyclic)
    value = replace(library, motions=(replace(cycle, travel=(1e-12, 0.0, -1e-12)),)).to_json()
    assert "travel" not in value["motions"][0]


def test_a_file_that_is_read_and_written_has_the_same_bytes(file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.json"
    write_library(again, read_library(file))
    assert again.read_bytes() == file.read_bytes()
    assert file.read_bytes().endswith(b"}\n")


def test_a_small_change_is_a_small_difference(file: Path, tmp_path: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert '\n        "knee.L.flexion": ' in text
    assert '{"time_s": 0.31, "posture": "Stand on one leg"}' in text
    assert max(len(line) for line in text.splitlines()) < 140


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


STEPS = [{"time_s": 0.01 * number, "posture": "Stand on one leg"} for number in range(10_001)]


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
        (("identifier",), "a" * 3_000_000, "identifier is"),
        (("postures",), VALID["postures"][:1] * 2000, "1 to 1000 postures"),
        (("motions",), [VALID["motions"][0]] * 101, "motions"),
        (("motions", 0, "steps"), STEPS, "10000 in all"),
    ],
)
def test_every_mistake_is_named(way: tuple[Any, ...], value: Any, said: str) -> None:
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
