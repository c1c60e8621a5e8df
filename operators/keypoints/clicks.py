"""The points that were clicked on in the frames of a take: adding, finding and removing them."""

import bpy

from ..shell.takes import footage_of


def clip_frame(take: bpy.types.PropertyGroup) -> int:
    """The scene's current frame, counted from the clip's first."""
    scene = take.id_data
    return int(scene.frame_current - footage_of(scene, take).first_frame)


def clicked_here(take: bpy.types.PropertyGroup) -> list[str]:
    """The points that were clicked on in the current frame."""
    here = clip_frame(take)
    return [click.point for click in take.follow.clicks if click.frame == here]


def set_click(
    take: bpy.types.PropertyGroup, point: str, pixel: tuple[float, float], frame: int | None = None
) -> None:
    """Set where a point is in a frame, the current one by default, in place of an earlier click."""
    at = clip_frame(take) if frame is None else frame
    remove_click(take, point, at)
    click = take.follow.clicks.add()
    click.point, click.frame, click.pixel = point, at, pixel


def remove_click(take: bpy.types.PropertyGroup, point: str, frame: int) -> bool:
    """Remove the click on a point in a frame; return whether there was one."""
    clicks = take.follow.clicks
    found = [i for i in range(len(clicks)) if (clicks[i].point, clicks[i].frame) == (point, frame)]
    for index in reversed(found):
        clicks.remove(index)
    return bool(found)
