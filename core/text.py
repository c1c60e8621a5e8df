"""Words for numbers of things."""


def pluralize(count: int, one: str, many: str | None = None) -> str:
    """`1 take`, `2 takes`; `many` is the plural where it is not `one` with an s."""
    return f"{count} {one if count == 1 else many or one + 's'}"
