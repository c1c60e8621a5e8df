"""One spelling everywhere, the American, as in Blender: in code, in texts for people, and on pages."""

import re
from pathlib import Path

import pytest

FOLDERS = ("core", "operators", "tests", "benchmarks", "tools", "docs", "presets/schemas")
PAGES = ("README.md", "CONTRIBUTING.md", "blender_manifest.toml", "pyproject.toml", "__init__.py")
ENDINGS = frozenset({".py", ".md", ".json", ".toml", ".js", ".css", ".yaml"})
OUR = ("col", "behavi", "neighb", "fav", "arm", "hon", "rum", "vap")
ISE = ("initial", "normal", "recogn", "optim", "general", "visual", "summar", "synchron", "minim", "maxim")
BRITISH = re.compile(
    rf"(?:{'|'.join(OUR)})o{'u'}r"
    rf"|(?:{'|'.join(ISE)})i{'s'}(?:e|ing|ation)"
    rf"|\bcent{'re'}s?\b|\b(?:centi|milli|kilo)?met{'re'}s?\b|\bgr{'ey'}s?\b"
    rf"|(?:label|model|travel)l{'ed'}\b",
    re.IGNORECASE,
)
"""Put together so that this file holds none of these words."""


def british(text: str) -> list[str]:
    """The words of a text that are spelled the British way."""
    return [found.group() for found in BRITISH.finditer(text)]


def test_spelling_is_american(repository: Path) -> None:
    files = [repository / name for name in PAGES]
    for folder in FOLDERS:
        files += [file for file in (repository / folder).rglob("*") if file.suffix in ENDINGS]
    assert len(files) > 500
    wrong = {
        str(file.relative_to(repository)): found
        for file in files
        if file.is_file() and (found := british(file.read_text(encoding="utf-8")))
    }
    assert wrong == {}


@pytest.mark.parametrize(
    "word", ["colo" + "ur", "Cent" + "re", "millimet" + "res", "gr" + "ey", "normali" + "se"]
)
def test_a_british_word_is_found(word: str) -> None:
    assert british(f"a {word} here") == [word]
    assert british("our hour, a promise, an exercise, meter, parameter, four, centered") == []
