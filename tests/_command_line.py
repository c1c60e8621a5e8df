"""What commands leave: the line on standard error, files, outcomes and the pages that show them."""

from dataclasses import dataclass, field, replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from keymark.core.shoot.outcomes import Outcome, Status
from keymark.core.take.conversion_record import ConversionRecord
from keymark.core.take.evidence import UsedEvidence, UsedKeypoints


def tree(folder: Path) -> dict[str, bytes | None]:
    """Every path below a folder, with the content of files."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }


def one_line(text: str) -> str:
    """The single line on standard error."""
    lines = text.splitlines()
    assert len(lines) == 1, text
    assert lines[0].startswith("keymark: ") or lines[0].startswith("blender --command keymark: ")
    return lines[0]


# --- Outcomes of imaginary takes, for tests of the pages that show them


FILES = ("motion.json", "motion.blend", "motion.bvh", "report/overlay.png")
RECORD = ConversionRecord(
    digest="00",
    keymark="0.0.0",
    take="walk",
    method="map",
    library=None,
    frames=120,
    frame_start=1,
    fps=30.0,
    keyframes=(1, 60, 120),
    matched=(),
    confidence=0.9,
    weakest=0.8,
    weak_frames=(87, 31),
    notes=("the frames are unevenly spaced in time",),
    files=dict.fromkeys(FILES, 64 * "0"),
    evidence=UsedEvidence(("trunk", "shin.L"), (UsedKeypoints("a detector", ("nose", "wrist.L"), 1.0),)),
)


def converted(output: Path, name: str, **changed: Any) -> Outcome:
    """A take that converted, with a record in which fields are changed."""
    return Outcome(name, output / name, Status.CONVERTED, replace(RECORD, **changed), None, 12.0)


def failed(output: Path, name: str, error: str, record: ConversionRecord | None = None) -> Outcome:
    """A take that failed."""
    return Outcome(name, output / name, Status.FAILED, record, error, 1.0)


def waiting(output: Path, name: str) -> Outcome:
    """A take that is not converted yet."""
    return Outcome(name, output / name, Status.WAITING)


# --- Parsed HTML pages: their elements in order, with the text in each


VOID = {"br", "meta", "img", "rect"}
"""Elements that are never closed, or close themselves."""


@dataclass
class Element:
    """An element with its attributes and all text below it."""

    tag: str
    attributes: dict[str, str]
    path: tuple[str, ...]
    """The tags around it."""
    text: str = ""


@dataclass
class Page(HTMLParser):
    """Every element of a page, in order."""

    markup: str
    elements: list[Element] = field(default_factory=list)

    def __post_init__(self) -> None:
        """Read the whole page; every element must be closed in turn."""
        super().__init__(convert_charrefs=True)
        self._open: list[Element] = []
        self.feed(self.markup)
        self.close()
        assert not self._open, [element.tag for element in self._open]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Begin an element."""
        names = [name for name, _ in attrs]
        assert len(names) == len(set(names)), names
        around = tuple(element.tag for element in self._open)
        element = Element(tag, {name: value or "" for name, value in attrs}, around)
        self.elements.append(element)
        if tag not in VOID:
            self._open.append(element)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Add an element that closes itself."""
        assert tag in VOID, tag
        self.handle_starttag(tag, attrs)

    def handle_endtag(self, tag: str) -> None:
        """End an element."""
        assert self._open.pop().tag == tag

    def handle_data(self, data: str) -> None:
        """Add text to all open elements."""
        for element in self._open:
            element.text += data

    def all(self, tag: str) -> list[Element]:
        """Every element of a kind."""
        return [element for element in self.elements if element.tag == tag]

    def rows(self) -> list[Element]:
        """The rows of takes."""
        return [element for element in self.all("tr") if element.attributes.get("class") == "take"]

    def shape(self) -> list[tuple[str, tuple[str, ...]]]:
        """Tags and attribute names of all elements, without texts and values."""
        return [(element.tag, tuple(element.attributes)) for element in self.elements]
