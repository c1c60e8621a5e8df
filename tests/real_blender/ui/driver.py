"""Runs a script of steps inside a Blender with a screen, and lets Blender go on between two of them.

A script is a generator. Each bare `yield` is one turn of Blender's main loop: events are handled, jobs
advance, the window is drawn. Nothing sleeps: `until` waits for what must become true. What a script expects
and does not find ends Blender with exit status 1, after a picture of the screen and a sentence.
"""

import os
import subprocess
import sys
import traceback
from collections.abc import Callable, Generator
from pathlib import Path
from time import monotonic
from typing import TypeVar

import bpy

Result = TypeVar("Result")
Steps = Generator[None, None, Result]  # A part of a script, and what it returns

PATIENCE_S = 120.0
"""How long something may take that is not a job; a laden machine draws a window in a second."""
JOB_PATIENCE_S = 1500.0


class UnexpectedError(Exception):
    """What a script expected is not so."""


def expect(condition: object, sentence: str) -> None:
    """Go on only if `condition` holds.

    Raises:
        UnexpectedError: It does not; the sentence says what should have been.
    """
    if not condition:
        raise UnexpectedError(sentence)


def turns(count: int) -> Steps[None]:
    """Let Blender go through its main loop so many times."""
    for _ in range(count):
        yield


def until(condition: Callable[[], object], what: str, patience_s: float = PATIENCE_S) -> Steps[None]:
    """Wait until `condition` holds.

    Raises:
        UnexpectedError: It did not within `patience_s`.
    """
    started = monotonic()
    while not condition():
        expect(monotonic() - started < patience_s, f"waited {patience_s:g} s in vain for {what}")
        yield


class Camera:
    """Takes numbered pictures of the screen."""

    def __init__(self, folder: Path, only: bool = True) -> None:
        self.folder = folder
        self.taken = 0
        folder.mkdir(parents=True, exist_ok=True)
        if only:
            for old in folder.glob("*.png"):
                old.unlink()

    def shoot(self, name: str) -> None:
        """Draw the window with smooth lines and keep a picture of the screen as NN_name.png."""
        self.taken += 1
        self._keep(f"{self.taken:02d}_{name}.png")

    def seen(self) -> bytes:
        """The colors of all pixels of the window, as it is drawn now."""
        return self._import("rgb:-")

    def _keep(self, file_name: str) -> None:
        bpy.context.preferences.system.viewport_aa = "FXAA"
        self._import(str(self.folder / file_name))
        bpy.context.preferences.system.viewport_aa = "OFF"

    def _import(self, target: str) -> bytes:
        """Blender's own screenshot operator gives black pictures on a virtual screen."""
        window = bpy.context.window_manager.windows[0]
        with bpy.context.temp_override(window=window):
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
        # The window stands in the lower left corner of the screen.
        own = ["-gravity", "SouthWest", "-crop", f"{window.width}x{window.height}+0+0", "+repage"]
        command = ["import", "-window", "root", *own, target]
        return subprocess.run(command, check=True, capture_output=True).stdout

    def shoot_failure(self) -> None:
        """Keep a picture of what the screen shows now, whatever else is broken."""
        try:
            self._keep("failed.png")
        except Exception:
            traceback.print_exc()


def drive(script: Steps[None], camera: Camera) -> None:
    """Run a script once Blender's window is up, then leave Blender: status 0 if it went through, else 1."""

    def turn() -> float | None:
        try:
            next(script)
        except StopIteration:
            print("The script went through", flush=True)
            bpy.ops.wm.quit_blender()
            return None
        except BaseException as error:
            camera.shoot_failure()
            if isinstance(error, UnexpectedError):
                at = traceback.extract_tb(error.__traceback__)[-2]
                print(f"UNEXPECTED at {Path(at.filename).name}:{at.lineno}: {error}", flush=True)
            else:
                traceback.print_exc()
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(1)  # an exception in a timer would only be printed, and Blender would go on
        return 0.0

    bpy.context.preferences.view.show_splash = False
    bpy.context.preferences.system.viewport_aa = "OFF"  # Drawn without a GPU, it takes half of all time
    bpy.app.timers.register(turn, first_interval=1.0, persistent=True)
