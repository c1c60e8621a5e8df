"""Sentences for people, and words for numbers of things."""

from typing import Any


class Sentence(str):
    """A sentence that remembers what it was made of, so that Blender can show it in another language.

    Everywhere else it is the English text that it says.
    """

    template: str
    """The sentence with its values in braces, as translators know it."""
    values: dict[str, Any]
    """The values by name; words among them stay as they are unless they are sentences themselves."""

    def __new__(cls, template: str, /, **values: Any) -> "Sentence":
        """Fill in the values."""
        made = super().__new__(cls, template.format(**values))
        made.template, made.values = template, values
        return made

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        """What copies and pickles are made from."""
        return (self.template,), self.values


def pluralize(count: int, one: str, many: str | None = None) -> str:
    """`1 take`, `2 takes`; `many` is the plural where it is not `one` with an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"
