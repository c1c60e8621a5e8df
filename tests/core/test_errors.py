"""Words for numbers of things."""

from keymark.core.errors import pluralize


def test_one_is_not_several() -> None:
    assert [pluralize(count, "take") for count in (0, 1, 2)] == ["0 takes", "1 take", "2 takes"]
    assert pluralize(3, "person", "people") == "3 people"
