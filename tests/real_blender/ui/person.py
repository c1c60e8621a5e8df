"""The person of a session: hands, what they know of the take, and how they try to undo a step."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from time import monotonic
from types import ModuleType
from typing import Any

import bpy
from _panel import controls
from _scene_state import differences, scene_state
from driver import JOB_PATIENCE_S, Camera, Steps, expect, turns, until
from hands import Hands

EXTENSION = "bl_ext.user_default.keymark"
JOB = "KEYMARK_OT_"
MOST_CONTROLS = 25
"""As many as the sidebar shows at any time; a panel that shows more is read by nobody."""


def keymark(module: str) -> ModuleType:
    """A module of the extension as it is installed in this Blender."""
    return import_module(f"{EXTENSION}.{module}")


class Person:
    """An animator in front of Blender."""

    def __init__(self, take_folder: Path, folder: Path, camera: Camera, *, hurried: bool = False) -> None:
        """Look at the take first.

        Args:
            take_folder: The take whose files stand for what the animator knows.
            folder: Where results go.
            camera: Takes pictures of the screen.
            hurried: Go straight to the result: nothing is cancelled or undone on the way.
        """
        self.hurried = hurried
        self.known = keymark("core.take.take_file").read_take(take_folder)
        self.folder = folder
        self.camera = camera
        self.hands = Hands()
        self.start_counting()

    @property
    def scene(self) -> bpy.types.Scene:
        return self.hands.window.scene

    @property
    def take(self) -> bpy.types.PropertyGroup:
        return keymark("operators.shell.takes").active_take(self.scene)

    @property
    def state(self) -> Any:
        """What the active take has come to, now."""
        return keymark("operators.shell.take_state").TakeState(self.take)

    def look(self, name: str) -> Steps[None]:
        yield from turns(4)
        self.camera.shoot(name)
        failed = keymark("operators.overlays.registry").FAILURES
        expect(not failed, f"overlays failed: {failed}")
        shown = controls()
        expect(len(shown) <= MOST_CONTROLS, f"the sidebar shows {len(shown)} controls: {shown}")
        print(f"{name}: {len(shown)} controls", flush=True)

    def step_done(self, message: str) -> None:
        """Mark what was done by other means than Keymark's operators as a step that undo comes back to."""
        bpy.ops.ed.undo_push(message=message)

    def jobs(self) -> list[str]:
        """The modal operators of Keymark that run in the window."""
        return [o.bl_idname for o in self.hands.window.modal_operators if o.bl_idname.startswith(JOB)]

    def wait_for_job(self) -> Steps[None]:
        begun = monotonic()
        yield from turns(3)
        yield from until(lambda: not self.jobs(), "the job's end", JOB_PATIENCE_S)
        self.waited_s += monotonic() - begun
        yield from turns(3)

    def start_counting(self) -> None:
        self.hands.clicks = self.hands.keys = 0
        self.started, self.waited_s = monotonic(), 0.0

    def summary(self) -> str:
        """How much work it was so far, and how long it took on this machine."""
        minutes = (monotonic() - self.started) / 60.0
        return (
            f"{self.hands.clicks} clicks and {self.hands.keys} keys; {minutes:.1f} minutes with the search "
            f"for every button, {self.waited_s / 60.0:.1f} of them waiting for Keymark"
        )

    def undoable(self, what: str, do: Callable[[], Steps[Any]]) -> Steps[None]:
        """Do something; hold that Ctrl Z takes all of it back and Ctrl Shift Z brings all of it again."""
        if self.hurried:
            yield from do()
            return
        before = scene_state()
        yield from do()
        after = scene_state()
        expect(after != before, f"{what} changed nothing")
        yield from self.hands.undo()
        left = differences(before, scene_state())
        expect(not left, f"undoing {what} left: {left}")
        yield from self.hands.redo()
        left = differences(after, scene_state())
        expect(not left, f"redoing {what} gave something else: {left}")

    def changes_nothing(self, what: str, do: Callable[[], Steps[Any]]) -> Steps[None]:
        """Do something that is cancelled; hold that the scene is as it was."""
        if self.hurried:
            return
        before = scene_state()
        yield from do()
        left = differences(before, scene_state())
        expect(not left, f"{what} left: {left}")
