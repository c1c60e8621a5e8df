"""Which of the people in one motion file is meant: one of them whole, never parts of two."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..errors import InputError, shown
from ..files.fields import listed


def chosen_subject(
    path: Path, names: Sequence[str], completeness: Sequence[float], wanted: str | None
) -> tuple[int, tuple[str, ...]]:
    """The index of the wanted subject, or else of the most complete, the first of equals; and notes.

    Raises:
        InputError: Nobody is called so; the sentence lists all.
    """
    every = listed([shown(name) for name in names], 10)
    if wanted is not None:
        if wanted not in names:
            raise InputError(f"{path}: has no subject {shown(wanted)}; its subjects are {every}")
        return names.index(wanted), ()
    index = int(np.argmax(completeness))
    note = (
        f"{path.name} has {len(names)} subjects, {every}; the motion is that of {shown(names[index])}, and "
        "mend --subject names another"
    )
    return index, (note,) if len(names) > 1 else ()
