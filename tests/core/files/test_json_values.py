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
