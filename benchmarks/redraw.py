"""Keymark's share of a redraw of Blender's window, for a take of 3,000 frames.

Usage: blender --addons bl_ext.user_default.keymark --window-geometry 0 0 1600 1000 --python redraw.py

Needs a Blender with the extension and a screen, a virtual one too. The demonstration take's motion is
repeated to 3,000 frames. Each row is the processor time of one redraw of the whole window during playback,
and the main thread's part of it: the pixels of a virtual screen are computed by other threads instead of a
graphics card.
"""

import os
import sys
import time
import traceback
from collections.abc import Callable, Generator
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path
from types import ModuleType

import bpy
import numpy as np

EXTENSION = "bl_ext.user_default.keymark"
DEMO = Path(__file__).resolve().parent.parent / "presets" / "demo" / "aerobic"
FRAMES = 3000
REDRAWS = 40
STRIDE = 29
"""Frames from one redraw to the next, within the clip, so that no cached drawing is reused."""
SWITCHES = ("show_observed", "show_predicted", "show_skeleton", "show_paths", "show_legend")
TIMELINE = ("show_speed", "show_proposals", "show_confidence", "show_weak_frames")


def keymark(module: str) -> ModuleType:
    """A module of the extension."""
    return import_module(f"{EXTENSION}.{module}")


def long_take() -> bpy.types.PropertyGroup:
    """The demonstration take, reconstructed, with its motion repeated to FRAMES frames."""
    bpy.ops.keymark.open_take(filepath=str(DEMO))
    bpy.ops.keymark.reconstruct()
    scene = bpy.context.scene
    take = keymark("operators.shell.takes").active_take(scene)
    results = keymark("operators.shell.results")
    short = results.review_of(take)
    index = np.arange(FRAMES) % len(short.frames)
    longer = {
        field.name: getattr(short, field.name)[index]
        for field in fields(short)
        if np.ndim(getattr(short, field.name)) and len(getattr(short, field.name)) == len(short.frames)
    }
    longer["frames"] = 1.0 + np.arange(FRAMES)
    longer["keyframe_indices"] = np.arange(0, FRAMES, 10)
    review = replace(short, **longer)
    results.keep_review(take, review)
    keymark("operators.review.review_results").show_review(take, review)
    take.proposals.clear()
    for frame in range(1, FRAMES + 1, 10):
        take.proposals.add().frame = frame
    scene.frame_end = FRAMES
    return take


def measure(change: Callable[[], object]) -> tuple[float, float]:
    """Processor time of a redraw, and the main thread's share of it [ms], after a change of the display."""
    change()
    scene, window = bpy.context.scene, bpy.context.window_manager.windows[0]
    clip_frames = scene.active_clip.frame_duration
    every, own = 0.0, 0.0
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.redraw_timer(type="DRAW_WIN", iterations=3)
        for redraw in range(REDRAWS):
            scene.frame_set(1 + STRIDE * redraw % clip_frames)
            started = time.process_time(), time.thread_time()
            bpy.ops.wm.redraw_timer(type="DRAW_WIN", iterations=1)
            every += time.process_time() - started[0]
            own += time.thread_time() - started[1]
    return 1000.0 * every / REDRAWS, 1000.0 * own / REDRAWS


def switch(on: bool) -> None:
    """Switch all overlays."""
    settings = bpy.context.scene.keymark
    for name in SWITCHES:
        setattr(settings.overlays, name, on)
    for name in TIMELINE:
        setattr(settings.timeline, name, on)


def sidebar(category: str) -> None:
    """Show a tab of the viewport's sidebar."""
    for area in bpy.context.window_manager.windows[0].screen.areas:
        if area.type == "VIEW_3D":
            region = next(region for region in area.regions if region.type == "UI")
            region.active_panel_category = category
            area.tag_redraw()


def benchmark() -> Generator[None, None, None]:
    """Measure with overlays and panel, without overlays, and without the panel."""
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")
    area.spaces.active.show_region_ui = True
    for _ in range(5):
        yield
    long_take()
    area.spaces.active.region_3d.view_perspective = "CAMERA"
    yield
    rows = []
    for name, on, tab in (
        ("everything", True, "Keymark"),
        ("panel, no overlays", False, "Keymark"),
        ("neither", False, "View"),
    ):
        sidebar(tab)
        yield
        rows.append((name, *measure(lambda on=on: switch(on))))
    print("\n| shown | processor time [ms] | of the main thread [ms] |\n|---|---|---|")
    for name, every, own in rows:
        print(f"| {name} | {every:.1f} | {own:.1f} |")
    print(
        f"\nKeymark's part: {rows[0][1] - rows[2][1]:.1f} ms, {rows[0][2] - rows[2][2]:.1f} ms in its thread"
    )


def run() -> None:
    """Run the benchmark once the window is up, then leave Blender."""
    steps = benchmark()

    def turn() -> float | None:
        try:
            next(steps)
        except StopIteration:
            bpy.ops.wm.quit_blender()
            return None
        except Exception:
            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)
        return 0.1

    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(turn, first_interval=1.0, persistent=True)


if __name__ == "__main__":
    run()
