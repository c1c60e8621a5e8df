"""Parsed HTML pages: their elements in order, with the text in each."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

VOID = {"br", "meta", "img", "input", "wbr", "rect"}
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
        return [element for element in self.all("tr") if element.attributes.get("id", "").startswith("take-")]

    def shape(self) -> list[tuple[str, tuple[str, ...]]]:
        """Tags and attribute names of all elements, without texts and values."""
        return [(element.tag, tuple(element.attributes)) for element in self.elements]
