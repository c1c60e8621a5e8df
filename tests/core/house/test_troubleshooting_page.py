"""docs/troubleshooting.md has every note and warning that the program can give, and no other."""

import re
from pathlib import Path

import pytest
from _sentences import all_notes_and_warnings, notes_and_warnings

TABLE = re.compile(r"^\| it says \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", re.MULTILINE)
LINK = re.compile(r"\]\(([\w.]*)#([\w-]+)\)")


@pytest.fixture(scope="module")
def page(repository: Path) -> str:
    """The page."""
    return (repository / "docs" / "troubleshooting.md").read_text(encoding="utf-8")


def on_page(template: str) -> str:
    """A template as the page has it: without the digits of its numbers, and with plain braces."""
    return re.sub(r"\{(\w+):[^{}]*\}", r"{\1}", template).replace("{{", "{").replace("}}", "}")


def rows(page: str) -> list[list[str]]:
    """The rows of the page's tables of notes and warnings."""
    lines = [line for table in TABLE.findall(page) for line in table.splitlines()]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def difference(page: str, templates: set[str]) -> tuple[list[str], list[str]]:
    """What the page lacks, and what it has that nobody says."""
    told = [row[0].strip("`") for row in rows(page)]
    assert len(told) == len(set(told))
    said = {on_page(template) for template in templates}
    return sorted(said - set(told)), sorted(set(told) - said)


def test_every_note_and_warning_is_on_the_page_and_no_other(page: str, repository: Path) -> None:
    """A new sentence needs a row that says why it comes and what to do; an old one goes with its row."""
    templates = set(all_notes_and_warnings(repository))
    assert len(templates) > 100
    assert difference(page, templates) == ([], [])


def test_every_row_says_why_and_what_to_do(page: str) -> None:
    """Three cells, none of them empty."""
    assert [row for row in rows(page) if len(row) != 3 or not all(row)] == []


def test_a_difference_is_found() -> None:
    """The check above can fail both ways; numbers are compared without their digits."""
    page = "| it says | why | what to do |\n|---|---|---|\n| `{a} of {b}` | x | y |\n| `gone` | x | y |\n"
    assert difference(page, {"{a:.1f} of {b:g}", "new {{c}}"}) == (["new {c}"], ["gone"])


def test_notes_are_told_from_errors() -> None:
    """A sentence of an error is none; one that is only reported as a warning is."""
    source = (
        'def f(self, name):\n    say(self, "WARNING", "Look at {name}", name=name)\n'
        '    say(self, "INFO", "Done")\n    raise InputError(Sentence("no {name}", name=name))\n'
        'NOTE = Sentence("all are well")\n'
    )
    assert set(notes_and_warnings(source)) == {"Look at {name}", "all are well"}


def test_links_lead_to_headings(page: str, repository: Path) -> None:
    """Of this page and of others."""
    found = LINK.findall(page)
    assert len(found) > 10
    for file, anchor in found:
        text = page if not file else (repository / "docs" / file).read_text(encoding="utf-8")
        headings = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
        known = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
        assert anchor in known, f"{file}#{anchor}"
    for file in re.findall(r"\]\(([\w.]+\.md)\)", page):
        assert (repository / "docs" / file).is_file(), file
