"""Cache of the results last used, which also remembers that a result is absent."""

from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

Result = TypeVar("Result")

DEFAULT_SIZE = 6
"""Results of one kind: those of the takes at hand."""


class LruCache(Generic[Result]):
    """Results by key; when it is full, the least recently used one is dropped. None: known to be absent."""

    def __init__(self, size: int = DEFAULT_SIZE) -> None:
        """Begin empty."""
        self._size = size
        self._results: OrderedDict[str, Result | None] = OrderedDict()

    def get(self, key: str, load: Callable[[], Result | None]) -> Result | None:
        """Return the result of a key; the first time, what `load` returns."""
        if key not in self._results:
            self.put(key, load())
        self._results.move_to_end(key)
        return self._results[key]

    def put(self, key: str, result: Result | None) -> None:
        """Add or replace a result."""
        self._results[key] = result
        self._results.move_to_end(key)
        while len(self._results) > self._size:
            self._results.popitem(last=False)

    def clear(self) -> None:
        """Drop all results."""
        self._results.clear()
