"""Schemas agree with readers: a schema accepts what its reader accepts, and both refuse mistakes."""

import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from _formats import Format, formats
from _fuzz import FUZZ, changed
from _synthetic_take import SIZE
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from keymark.core.errors import InputError
from keymark.core.files.json_file import parse_json
from referencing import Registry, Resource

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools"))
import make_schemas

NAMES = (
    *("take", "keyframes", "shoot", "takes", "library", "character", "motion", "conversion", "retarget"),
    *("keypoints", "truth"),
)


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Format]:
    return formats(tmp_path_factory.mktemp("formats"))


@cache
def schemas() -> dict[str, Any]:
    folder = Path(__file__).parents[3] / "presets" / "schemas"
    return {path.name: json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.schema.json")}


@cache
def validator(name: str, whole: bool = False) -> Draft202012Validator:
    """The validator of a schema, or of its part `complete`."""
    resources = [(file, Resource.from_contents(schema)) for file, schema in schemas().items()]
    part = "#/$defs/complete" if whole else ""
    schema = {"$ref": f"{name}.schema.json{part}"}
    return Draft202012Validator(schema, registry=Registry().with_resources(resources))


def test_there_is_a_schema_for_every_format() -> None:
    assert set(schemas()) == {f"{name}.schema.json" for name in NAMES}
    for schema in schemas().values():
        Draft202012Validator.check_schema(schema)
        assert schema["title"] and schema["description"]


@pytest.mark.parametrize("name", NAMES)
def test_schemas_are_made_of_the_declarations(name: str, repository: Path) -> None:
    file = repository / "presets" / "schemas" / f"{name}.schema.json"
    assert file.read_text(encoding="utf-8") == make_schemas.text_of(name)


def fields_of(schema: Any) -> list[tuple[str, Any]]:
    """Every field named in a schema, with its own schema."""
    found: list[tuple[str, Any]] = []
    if isinstance(schema, dict):
        for name, one in schema.get("properties", {}).items():
            found += [(name, one)] if isinstance(one, dict) else []
        for name, one in schema.items():
            found += fields_of(list(one.values()) if name in ("properties", "$defs") else one)
    elif isinstance(schema, list):
        for one in schema:
            found += fields_of(one)
    return found


@pytest.mark.parametrize("name", NAMES)
def test_numbers_and_texts_have_limits(name: str) -> None:
    for field, schema in fields_of(schemas()[f"{name}.schema.json"]):
        kinds = schema.get("type", ())
        kinds = {kinds} if isinstance(kinds, str) else set(kinds)
        if kinds & {"number", "integer"} and "description" in schema:
            assert "minimum" in schema and "maximum" in schema, field
        if "string" in kinds and "$schema" not in field:
            assert "maxLength" in schema or "pattern" in schema, field


@pytest.mark.parametrize("name", NAMES)
def test_schema_and_reader_accept_a_valid_file(known: dict[str, Format], name: str) -> None:
    one = known[name]
    assert list(validator(name, one.whole).iter_errors(one.valid)) == []
    assert not refused_by_reader(one, one.valid)


def test_shipped_files_are_valid(repository: Path, shared_takes: Path) -> None:
    libraries = sorted((repository / "presets" / "keyframes").glob("*.json"))
    assert libraries
    for path in libraries:
        value = json.loads(path.read_text(encoding="utf-8"))
        assert list(validator("library").iter_errors(value)) == [], path
    for take in [repository / "presets" / "demo" / "aerobic", *shared_takes.iterdir()]:
        files = {
            "take.json": ("take", True),
            "keyframes.json": ("keyframes", False),
            "truth.json": ("truth", False),
        }
        files["keyframes_noisy.json"] = ("keyframes", False)
        for file, (name, whole) in files.items():
            if (take / file).exists():
                value = json.loads((take / file).read_text(encoding="utf-8"))
                assert list(validator(name, whole).iter_errors(value)) == [], take / file


def refused_by_reader(one: Format, value: Any) -> bool:
    try:
        one.read(json.dumps(value).encode())
    except InputError:
        return True
    return False


def as_read(value: Any) -> Any:
    """A value after a round trip through JSON, or None if JSON cannot express it."""
    try:
        return parse_json(json.dumps(value), "here")
    except InputError:
        return None


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.fuzz
@settings(max_examples=25 * FUZZ, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_readers_refuse_what_schemas_refuse(known: dict[str, Format], name: str, data: st.DataObject) -> None:
    one = known[name]
    value = as_read(data.draw(changed(one.valid, 2)))
    if value is not None and not validator(name, one.whole).is_valid(value):
        assert refused_by_reader(one, value), next(validator(name, one.whole).iter_errors(value)).message


Change = Callable[[Any], object]


def at(*way: Any, to: Any) -> Change:
    def change(value: Any) -> None:
        for key in way[:-1]:
            value = value[key]
        value[way[-1]] = to

    return change


MISTAKES: list[tuple[str, Change]] = [
    ("take", lambda v: v.pop("fps")),
    ("take", at("fps", to=0)),
    ("take", at("clip", to="../clip.mp4")),
    ("take", at("camera", "resolution", to=[SIZE[0], 1.5])),
    ("take", at("camera", "matrix_world", to=[[1, 0, 0, 0]] * 3)),
    ("take", at("keypoints", to="../keypoints.json")),
    ("take", at("evidence", to=["markers", "sound"])),
    ("take", at("evidence", to=["markers", "depth_hints"])),
    ("take", at("ignored_regions", 0, "box", to=[1, 2, 3])),
    ("take", at("ignored_regions", 0, "frames", to=[1.5, 2])),
    ("take", at("ignored_regions", 1, "box", to=[1, 2, 3, 4])),
    ("take", at("markers", "tail", to={"color_srgb": [1, 2, 3], "segment": "tail"})),
    ("take", at("method", to="magic")),
    ("take", at("character", "file", to="../anna.blend")),
    ("take", at("character", "arms", to="bone")),
    ("take", at("character", "tolerance_mm", to=-1)),
    ("take", at("character", "bones", to=[])),
    ("keyframes", at("keyframes", 0, "frame", to=1.5)),
    ("keyframes", at("keyframes", 1, "posture", "tail.wag", to=0.1)),
    ("keyframes", at("keyframes", 1, "matched", "confidence", to=1.1)),
    ("keyframes", lambda v: v["keyframes"][0].pop("points")),
    ("shoot", at("actr", to={})),
    ("shoot", at("root", to=1)),
    ("shoot", at("schema_version", to=2)),
    ("takes", lambda v: v.pop("take")),
    ("takes", at("take", to="../elsewhere")),
    ("library", at("identifier", to="../up")),
    ("library", at("postures", to=[])),
    ("library", at("motions", 1, "travel", to={"x_m": 1, "y_m": 0, "heading_rad": 0})),
    ("character", at("roles", "tail", to={"bones": ["tail"]})),
    ("character", at("roles", "hips", "bones", to=["a", "b"])),
    ("character", at("roles", "spine", "bones", to=["a", "a"])),
    ("character", at("roles", "spine", "shares", to=[0.5, 1.5])),
    ("character", at("ik", "arm.L", "toe", to="toe")),
    ("character", at("ik", "leg.R", "goal", to=None)),
    ("character", at("soles", "hand.L", to=[[0, 0, 0]])),
    ("character", at("rest_corrections", "upper_arm.L", to=[2, 0, 0, 0])),
    ("character", at("left_alone", to=["tail"])),
    ("motion", at("points", "head", 0, to=[0, 1])),
    ("motion", at("diagnostics", "cost", 0, to="1")),
    ("conversion", at("files", "../up", to="ab" * 32)),
    ("conversion", at("files", "a", to="ab")),
    ("retarget", at("quality", "hands_mm", to="1")),
    ("retarget", at("limbs", "arm.L", to="none")),
    ("retarget", at("character", "sha256", to="x")),
    ("keypoints", lambda v: v.pop("layout")),
    ("keypoints", at("names", to=["shoulder.L", "shoulder.L"])),
    ("keypoints", at("names", 0, to="tail")),
    ("keypoints", lambda v: v.pop("frames")),
    ("keypoints", at("frames", 0, to={})),
    ("keypoints", at("frames", 0, 1, to=[1, 2])),
    ("keypoints", at("frames", 0, 1, 2, to=None)),
    ("keypoints", at("frames", 0, 1, 0, to=True)),
    ("keypoints", at("world", 0, 0, 2, to=1e3)),
    ("keypoints", at("by_hand", to=1)),
    ("keypoints", at("fps", to=0)),
    ("truth", at("points", "head", 0, to=[0, None, 1])),
]


@pytest.mark.parametrize(("name", "change"), MISTAKES)
def test_schema_and_reader_refuse_a_mistake(known: dict[str, Format], name: str, change: Change) -> None:
    one = known[name]
    value = json.loads(json.dumps(one.valid))
    change(value)
    assert not validator(name, one.whole).is_valid(value)
    assert refused_by_reader(one, value)


def test_a_partial_take_is_valid_below_a_shoot(known: dict[str, Format]) -> None:
    assert validator("take").is_valid({}) and validator("take").is_valid({"camera": {"lens_mm": None}})
    assert not validator("take", True).is_valid({})
    assert validator("shoot").is_valid({"$schema": "shoot.schema.json", "//": 1})
