"""The zips there are: every supported Blender has one, no two are for the same, and manifests say so."""

import sys
import tomllib
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from package.builds import EVERYWHERE, SERIES, Series, chosen  # noqa: E402
from package.staging import with_fields  # noqa: E402
from package.wheels import BINARY_INTERFACES, TAGS, pins  # noqa: E402

BLENDERS = [
    ((4, 5, 0), "3.11"),
    ((4, 5, 15), "3.11"),
    ((5, 0, 1), "3.11"),
    ((5, 1, 0), "3.13"),
    ((5, 2, 2), "3.13"),
    ((5, 2, 2), "3.14"),
]
"""Versions of Blender with their Pythons: official ones, and Debian's."""


def fits(series: Series, version: tuple[int, ...], python: str) -> bool:
    """Whether a Blender enables a zip of the series: by its range, without the end, and its wheels."""
    first, end = (tuple(map(int, words.split("."))) for words in (series.first, series.end))
    return first <= version < end and series.python == python


@pytest.mark.parametrize(("version", "python"), BLENDERS)
def test_every_blender_has_one_zip(version: tuple[int, ...], python: str) -> None:
    assert sum(fits(series, version, python) for series in SERIES) == 1


def test_official_blenders_have_one_on_every_platform() -> None:
    assert [series.python for series in SERIES if series.platforms == EVERYWHERE] == ["3.11", "3.13"]


def test_zips_are_chosen_by_python_and_platform() -> None:
    names = [build.name("1.2.3") for build in chosen((), ())]
    assert len(set(names)) == len(names) == 7
    (only,) = chosen(("3.13",), ("windows-x64",))
    assert only.name("1.2.3") == "keymark-1.2.3-blender_5.1_or_newer-windows_x64.zip"
    assert list(chosen(("3.14",), ("windows-x64",))) == []


def test_every_wheel_is_pinned_and_every_platform_known() -> None:
    for series in SERIES:
        assert set(BINARY_INTERFACES) <= set(pins(series.python))
    assert pins("3.14")["onnxruntime"] != pins("3.13")["onnxruntime"] == pins("3.11")["onnxruntime"]
    assert set(TAGS) == set(EVERYWHERE)


def test_a_zips_manifest_differs_in_its_fields_alone(repository: Path) -> None:
    text = (repository / "blender_manifest.toml").read_text(encoding="utf-8")
    given: dict[str, str | list[str]] = {
        "version": "9.8.7",
        "platforms": ["linux-x64"],
        "wheels": ["./a b.whl"],
    }
    assert tomllib.loads(with_fields(text, given)) == {**tomllib.loads(text), **given}
    assert tomllib.loads(with_fields('id = "a"\n', given)) == {"id": "a", **given}
