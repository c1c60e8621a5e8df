"""JSON: strict for our own fields, any value of other programs, and laid out for people."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.body.actor import Actor
from keymark.core.errors import InputError, shown
from keymark.core.files.json_file import WIDTH, format_json, read_json, read_json_value, write_readable_json
from keymark.core.files.kinds import Items, Number, Whole

NO_FLOAT_HOLDS_IT = 10**400


@pytest.mark.parametrize("value", [NO_FLOAT_HOLDS_IT, -NO_FLOAT_HOLDS_IT, float("inf"), float("nan"), True])
def test_what_is_no_number_of_the_range_is_refused_in_one_sentence(value: Any) -> None:
    one = Number(0.0, 3.0)
    kinds = (one, Whole(0, 3), Items("numbers", 1, 1, "a list of one number", item=one))
    for kind, each in zip(kinds, (value, value, [value]), strict=True):
        with pytest.raises(InputError, match=r"a\.json: size is .*; it must be a") as refusal:
            kind.read(each, "a.json", "size")
        assert len(str(refusal.value)) < 200


def test_a_length_of_the_body_no_float_holds_is_refused() -> None:
    with pytest.raises(InputError, match=r"actor\.segments_m: trunk is 1000"):
        Actor({**Actor.from_stature(1.8).segments_m, "trunk": NO_FLOAT_HOLDS_IT})


def write(folder: Path, text: str) -> Path:
    path = folder / "value.json"
    path.write_text(text, encoding="utf-8")
    return path


def test_lists_are_read_and_nan_is_null(tmp_path: Path) -> None:
    path = write(tmp_path, '[1, NaN, {"x": NaN}]')
    assert read_json_value(path) == [1, None, {"x": None}]
    for text in ("[1]", '{"x": NaN}'):
        with pytest.raises(InputError, match=r"value\.json"):
            read_json(write(tmp_path, text))


@pytest.mark.parametrize("text", ["[Infinity]", "[-Infinity]", "[1e999]", '{"x": 1, "x": 2}', "[1, 2", ""])
def test_the_rest_is_as_strict(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match=r"value\.json"):
        read_json_value(write(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('{"frames": [1, 2', "the file is cut off"),
        ('{"name": "wal', "the file is cut off"),
        ("", "the file is empty"),
        ('{"frame": 1}\n{"frame": 2}\n', "JSON Lines"),
        ("frame,nose_x,nose_y\n1,2.0,3.0\n", "a table (CSV)"),
        ("1;2;3\n4;5;6\n", "a table (CSV)"),
        ("[{'nose': [1, 2]}]", "what Python prints"),
        ('[{"nose": None}]', "what Python prints"),
        ("[array([1, 2])]", "what Python prints"),
    ],
)
def test_the_reason_is_what_the_text_is(tmp_path: Path, text: str, reason: str) -> None:
    with pytest.raises(InputError) as refused:
        read_json_value(write(tmp_path, text))
    assert reason in str(refused.value)


@pytest.mark.parametrize("text", ['[{"a": 1,, "b": 2}]', "[1 2]", '{"a": 1} {"b": 2}', "nothing of the kind"])
def test_no_reason_is_made_up(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError) as refused:
        read_json_value(write(tmp_path, text))
    assert str(refused.value).endswith(")")


NAMES = st.text(max_size=6) | st.sampled_from(["a.b_x", "a.b_y", "a.b_z", "a.c"])
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**9), 10**9) | st.floats(-1e6, 1e6) | st.text(max_size=30),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner, max_size=5),
    max_leaves=25,
)


@given(VALUES)
def test_the_layout_changes_nothing_but_spaces(value: object) -> None:
    text = format_json(value)
    assert json.loads(text) == value
    assert format_json(json.loads(text)) == text


def test_what_is_short_stands_in_one_line() -> None:
    value = {
        "tags": ["a", "b"],
        "values": {"hip.L.rotation_x": 0.1, "hip.L.rotation_z": 0.2, "knee.L.flexion": 0.3},
        "long": ["w" * 60, "v" * 60],
        "nested": [{"time_s": 0.0}, {"time_s": 0.1}],
    }
    assert format_json(value).splitlines() == [
        "{",
        '  "tags": ["a", "b"],',
        '  "values": {',
        '    "hip.L.rotation_x": 0.1, "hip.L.rotation_z": 0.2,',
        '    "knee.L.flexion": 0.3',
        "  },",
        '  "long": [',
        f'    "{"w" * 60}",',
        f'    "{"v" * 60}"',
        "  ],",
        '  "nested": [',
        '    {"time_s": 0.0},',
        '    {"time_s": 0.1}',
        "  ]",
        "}",
    ]


@pytest.mark.parametrize("more", [0, 1])
def test_a_list_is_broken_where_it_is_too_long(more: int) -> None:
    value = {"list": ["x" * (WIDTH - len('  "list": [""]') + more)]}
    assert len(format_json(value).splitlines()) == (5 if more else 3)


def test_numbers_must_be_finite(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        write_readable_json(tmp_path / "a.json", {"a": float("nan")})
    assert list(tmp_path.iterdir()) == []
    write_readable_json(tmp_path / "a.json", {"a": "ü"})
    assert (tmp_path / "a.json").read_bytes() == '{"a": "ü"}\n'.encode()
    assert read_json(tmp_path / "a.json") == {"a": "ü"}


def test_what_is_nested_too_deeply_is_shown_all_the_same() -> None:
    value: list[object] = []
    for _ in range(100_000):
        value = [value]
    assert len(shown(value)) <= 60
