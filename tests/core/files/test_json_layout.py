"""JSON for people."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from keymark.core.errors import shown
from keymark.core.files.json_file import WIDTH, format_json, read_json, write_readable_json

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
