"""Results that several pictures show, made once: the demonstration's motion, and a character with it."""

from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from pathlib import Path

import bpy
from keymark.core.take.examples import AEROBIC, POSED_BY_HAND, example_folder
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.operators.cli.main import main as keymark

from .figure import write_figure

DEMO = example_folder(AEROBIC)
KEYFRAMES = DEMO / POSED_BY_HAND
BLEND, CHARACTER = "motion.blend", "character.blend"


@dataclass(frozen=True)
class Results:
    """Results in a folder, made when they are first asked for."""

    folder: Path

    @property
    def take(self) -> Take:
        """The demonstration as a person posed it."""
        return read_take(DEMO, KEYFRAMES)

    @cached_property
    def converted(self) -> Path:
        """Folder of the demonstration's motion."""
        words = ("--keyframes", KEYFRAMES, "--evidence", "markers,contours")
        return self._made("demonstration", "convert", DEMO, *words)

    @cached_property
    def character(self) -> Path:
        """Folder of the character that has the motion."""
        figure = self.folder / "human.blend"
        write_figure(figure)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        return self._made("character", "retarget", self.converted, "--character", figure)

    def _made(self, name: str, *words: str | Path) -> Path:
        """Let the command line make a folder of results; returns it."""
        output = self.folder / name
        _keymark(*words, "--output", output)
        return output


def _keymark(*words: str | Path) -> None:
    """Run a command of Keymark's without its messages, but for an error's."""
    with redirect_stdout(StringIO()):
        status = keymark([*(str(word) for word in words), "--quiet"])
    if status:
        raise SystemExit(f"keymark {words[0]} failed; the sentence above says why")
