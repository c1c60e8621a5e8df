"""Keymark's share of a redraw of Blender's window, for a take of 3,000 frames.

Usage: blender --addons bl_ext.user_default.keymark --window-geometry 0 0 1600 1000 --python redraw.py

Needs a Blender with the extension and a screen, a virtual one too. The demonstration take's motion is
repeated to 3,000 frames. Each row is the processor time of going to a frame and redrawing the whole
window, and the main thread's part of it: the pixels of a virtual screen are computed by other threads instead
of a graphics card. Playback leaves masks out that would take more than their share of a frame's time.
"""

import os
import sys
import time
import traceback
from collections.abc import Callable, Collection, Generator
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy
import numpy as np

EXTENSION = "bl_ext.user_default.keymark"
DEMO = Path(__file__).resolve().parent.parent / "presets" / "demo" / "aerobic"
FRAMES = 3000
REDRAWS = 40
STRIDE = 29
"""Frames from one redraw to the next, within the clip, so that no cached drawing is reused."""
MASKS, ALL_SETTINGS = "masks", "settings"
ALL = frozenset((MASKS, ALL_SETTINGS))
"""What is shown: the overlays of the settings, and the markers' masks, which have a switch of their own."""
FRAME_S = 1.0 / 30.0
LARGEST_SHARE = 1.0 / 3.0
"""Of the time of a frame, which Keymark may take in Blender's main thread."""


def keymark(module: str) -> ModuleType:
    """A module of the extension."""
    return import_module(f"{EXTENSION}.{module}")


def long_take() -> bpy.types.PropertyGroup:
    """The demonstration take, reconstructed, with its motion repeated to FRAMES frames."""
    bpy.ops.keymark.open_take(filepath=str(DEMO))
    scene = bpy.context.scene
    take = keymark("operators.shell.takes").active_take(scene)
    take.follow.use_keypoints = True
    bpy.ops.keymark.check_markers()  # without it there are no masks
    bpy.ops.keymark.reconstruct()
    results = keymark("operators.shell.results")
    short = results.review_of(take)
    review = replace(
        repeated(short, len(short.frames)),
        keypoints=repeated(short.keypoints, len(short.frames)),
        frames=1.0 + np.arange(FRAMES),
        keyframe_indices=np.arange(0, FRAMES, 10),
    )
    results.keep_review(take, review)
    keymark("operators.review.review_results").show_review(take, review)
    take.proposals.clear()
    for frame in range(1, FRAMES + 1, 10):
        take.proposals.add().frame = frame
    scene.frame_end = FRAMES
    return take


def repeated(short: Any, count: int) -> Any:
    """A dataclass with its arrays of COUNT frames repeated to FRAMES frames."""
    index = np.arange(FRAMES) % count
    longer = {}
    for field in fields(short):
        value = getattr(short, field.name)
        if isinstance(value, np.ndarray) and value.ndim and len(value) == count:
            longer[field.name] = value[index]
    return replace(short, **longer)


def measure(change: Callable[[], object]) -> tuple[float, float]:
    """Processor time of a redraw, and the main thread's share of it [ms], after a change of the display."""
    change()
    scene, window = bpy.context.scene, bpy.context.window_manager.windows[0]
    clip_frames = scene.active_clip.frame_duration
    every, own = 0.0, 0.0
    with bpy.context.temp_override(window=window):
        bpy.ops.wm.redraw_timer(type="DRAW_WIN", iterations=3)
        for redraw in range(REDRAWS):
            started = time.process_time(), time.thread_time()
            scene.frame_set(1 + STRIDE * redraw % clip_frames)
            bpy.ops.wm.redraw_timer(type="DRAW_WIN", iterations=1)
            every += time.process_time() - started[0]
            own += time.thread_time() - started[1]
    return 1000.0 * every / REDRAWS, 1000.0 * own / REDRAWS


def switch(on: Collection[str]) -> None:
    """Switch the overlays of these names on, all others off, and show the path of every point."""
    settings = bpy.context.scene.keymark
    for group in (settings.overlays, settings.timeline):
        for name in group.bl_rna.properties.keys():
            if name.startswith("show_"):
                setattr(group, name, ALL_SETTINGS in on)
    bpy.context.window_manager.keymark_show_masks = MASKS in on
    points = settings.overlays.bl_rna.properties["path_points"].enum_items.keys()
    settings.overlays.path_points = set(points)


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
        ("everything", ALL, "Keymark"),
        ("everything but masks", ALL - {MASKS}, "Keymark"),
        ("panel, no overlays", frozenset(), "Keymark"),
        ("neither", frozenset(), "View"),
    ):
        sidebar(tab)
        yield
        rows.append((name, *measure(lambda on=on: switch(on))))
    print("\n| shown | processor time [ms] | of the main thread [ms] |\n|---|---|---|")
    for name, every, own in rows:
        print(f"| {name} | {every:.1f} | {own:.1f} |")
    whole, overlays = (tuple(a - b for a, b in zip(rows[1][1:], rows[i][1:], strict=True)) for i in (3, 2))
    print(f"\nKeymark's part without masks: {whole[0]:.1f} ms, {whole[1]:.1f} ms of it in the main thread")
    print(f"Their overlays' part: {overlays[0]:.1f} ms, {overlays[1]:.1f} ms of it in the main thread,")
    print(
        f"which is {overlays[1] / (1000.0 * FRAME_S):.2f} of a frame's time; "
        f"at most {LARGEST_SHARE:.2f} is the aim"
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
