"""docs/troubleshooting.md has only notes and warnings that the program gives, and says what to do."""

import re
from pathlib import Path

import pytest
from _sentences import all_sentences, sentences, without_names

TABLE = re.compile(r"^\| it says \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", re.MULTILINE)
LINK = re.compile(r"\]\(([\w.]*)#([\w-]+)\)")


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "troubleshooting.md").read_text(encoding="utf-8")


def rows(page: str) -> list[list[str]]:
    """The rows of the page's tables of notes and warnings."""
    lines = [line for table in TABLE.findall(page) for line in table.splitlines()]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def unsaid(page: str, said: set[str]) -> list[str]:
    """Sentences of the page that nobody says; names of values do not count."""
    told = [row[0].strip("`") for row in rows(page)]
    assert len(told) == len(set(told)) > 0
    return sorted(sentence for sentence in told if without_names(sentence) not in said)


def test_every_sentence_of_the_page_is_said(page: str, repository: Path) -> None:
    assert unsaid(page, all_sentences(repository)) == []


def test_every_row_says_why_and_what_to_do(page: str) -> None:
    assert [row for row in rows(page) if len(row) != 3 or not all(row)] == []


def test_a_sentence_that_nobody_says_is_found() -> None:
    page = "| it says | why | what to do |\n|---|---|---|\n| `{a} of {b}` | x | y |\n| `gone` | x | y |\n"
    assert unsaid(page, set(sentences('f"{first + 1} of {total:.1f}"'))) == ["gone"]


def test_links_lead_to_headings(page: str, repository: Path) -> None:
    found = LINK.findall(page)
    assert len(found) > 5
    for file, anchor in found:
        text = page if not file else (repository / "docs" / file).read_text(encoding="utf-8")
        headings = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
        known = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
        assert anchor in known, f"{file}#{anchor}"
    for file in re.findall(r"\]\(([\w.]+\.md)\)", page):
        assert (repository / "docs" / file).is_file(), file
