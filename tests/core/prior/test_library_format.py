"""The page that describes library files tells the truth."""

import json
import re
from pathlib import Path

import pytest
from keymark.core.prior import library as fields
from keymark.core.prior import library as library_file
from keymark.core.prior import texts
from keymark.core.prior import texts as text_fields
from keymark.core.prior.library import Library, read_library, write_library


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    return (repository / "docs" / "library_format.md").read_text(encoding="utf-8")


def test_the_example_is_a_library_and_laid_out_as_one(page: str, tmp_path: Path) -> None:
    (example,) = re.findall(r"```json\n(.*?)```", page, flags=re.DOTALL)
    (tmp_path / "given.json").write_text(example, encoding="utf-8")
    write_library(tmp_path / "nodding.json", read_library(tmp_path / "given.json"))
    assert (tmp_path / "nodding.json").read_text(encoding="utf-8") == example
    assert Library.from_json(json.loads(example), "here").motions[0].cyclic


def test_every_field_has_its_row(page: str) -> None:
    for name in Library.ORDER:
        assert f"`{name}`" in page.split("## A posture")[0]


@pytest.mark.parametrize(
    "words",
    [
        f"1 to {texts.LONGEST_IDENTIFIER} of a-z",
        f"| {texts.LONGEST_NAME} characters |",
        f"1 to {fields.HIGHEST_VERSION} |",
        f"{text_fields.LONGEST_LINE} characters",
        f"{text_fields.LONGEST_LICENSE} characters",
        f"{text_fields.LONGEST_TEXT} characters",
        f"{text_fields.MOST_TAGS} tags of {text_fields.LONGEST_TAG} characters",
        f"{fields.MOST_SOURCES} sources of {text_fields.LONGEST_TEXT}",
        f"{fields.MOST_MOTIONS}, together {fields.MOST_STEPS} steps",
        f"1 to {fields.MOST_POSTURES} |",
        f"({fields.SHORTEST_S:g} to {fields.LONGEST_S:g} s)",
        f"above {library_file.LARGEST_BYTES // 2**20} MiB",
    ],
)
def test_limits_are_those_of_the_reader(page: str, words: str) -> None:
    assert words in page
