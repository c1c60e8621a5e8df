"""Numbers of things, for sentences."""


def counted(count: int, one: str, many: str | None = None) -> str:
    """`1 take`, `2 takes`."""
    return f"{count} {one if count == 1 else many or one + 's'}"
