"""JSON files of other programs: any value, as strictly read as our own, but for NaN."""

from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.core.files.json_file import read_json, read_json_value


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
