"""The results that several pictures show, made once: the demonstration's motion, and a character that has it."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import bpy
from keymark.operators.cli.main import main as keymark
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

from .figure import write_figure

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "presets" / "demo" / "aerobic"
KEYFRAMES = DEMO / "keyframes_noisy.json"
"""With the errors that a person makes when posing."""
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
        output = self.folder / "demonstration"
        words = ["--keyframes", str(KEYFRAMES), "--evidence", "markers,contours"]
        return self._run("convert", str(DEMO), output, *words)

    @cached_property
    def matched(self) -> Path:
        """Folder of its motion without any posing, by the library of its kind."""
        return self._run("convert", str(DEMO), self.folder / "matched", "--library", "aerobic")

    @cached_property
    def character(self) -> Path:
        """Folder of the character that has the motion."""
        figure = self.folder / "human.blend"
        write_figure(figure)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        return self._run("retarget", str(self.converted), self.folder / "character", "--character", str(figure))

    def _run(self, command: str, source: str, output: Path, *words: str) -> Path:
        """Let the command line make a result; returns its folder."""
        if keymark([command, source, "--output", str(output), "--quiet", *words]):
            raise SystemExit(f"{output}: `keymark {command}` made no result; it says why above")
        return output
