"""The takes of a scene: finding one, adding one, switching between them."""

from collections.abc import Iterable, Iterator
from uuid import uuid4

import bpy
from bpy.app import timers
from bpy.types import Area, Context, Object, PropertyGroup, Scene

from ...core.camera.camera_fields import CameraPlacement
from ...core.detect.layouts import named_point
from ...core.errors import InputError
from ..bridge.footage import Footage, set_scene_range
from ..bridge.scene_evidence import AssignedTrack, clip_tracks

VERSION = 1  # version of Keymark's properties; each scene holds the version that wrote it


def active_take(scene: Scene) -> PropertyGroup:
    """The active take; InputError where the scene has none."""
    take = find_take(scene)
    if take is None:
        raise InputError(f"scene '{scene.name}' has no take; load the footage or open a take first")
    return take


def find_take(scene: Scene) -> PropertyGroup | None:
    """The active take; None if the scene has no take."""
    settings = scene.keymark
    if not len(settings.takes):
        return None
    return settings.takes[min(settings.active_take, len(settings.takes) - 1)]


def take_by_identifier(scene: Scene, identifier: str) -> PropertyGroup:
    """The take with an identifier, active or not; InputError where it was removed."""
    for take in scene.keymark.takes:
        if take.identifier == identifier:
            return take
    raise InputError("the take of this job was removed while it ran; nothing was changed")


def actor_of(take: PropertyGroup) -> Object:
    """A take's armature; InputError where it has none, or it was deleted."""
    if take.armature is None:
        raise InputError(f"take '{take.name}' has no actor; build one, or choose its armature")
    return take.armature


def add_take(scene: Scene, name: str) -> PropertyGroup:
    """Add a take and make it the active one; a number makes its name unique."""
    settings = scene.keymark
    settings.version = max(settings.version, VERSION)
    take = settings.takes.add()
    take.name = name  # its update makes it unique, see `unique_name`
    take.identifier = uuid4().hex
    settings.active_take = len(settings.takes) - 1
    return take


def unique_name(name: str, others: Iterable[str]) -> str:
    """A name that none of the others has, made unique by a number like Blender's own (`Walk.001`)."""
    taken = set(others)
    stem, _, number = name.rpartition(".")
    base = stem if stem and len(number) == 3 and number.isdigit() else name
    numbered = (f"{base}.{number:03d}" for number in range(1, len(taken) + 2))
    return name if name not in taken else next(free for free in numbered if free not in taken)


def ensure_take(scene: Scene) -> PropertyGroup:
    """The active take; if there is none, add the first one."""
    return find_take(scene) or add_take(scene, "Take")


def footage_of(scene: Scene, take: PropertyGroup) -> Footage:
    """A take's clip and camera in its scene."""
    return Footage(scene, take.clip, take.camera)


def show_active_take(scene: Scene) -> None:
    """Set the scene's clip, camera and frame range to the active take's, and select its actor."""
    take = find_take(scene)
    if take is None:
        return
    _select(scene, take.armature)
    if take.camera is not None and take.camera.name in scene.objects:
        scene.camera = take.camera
    clip = take.clip
    if clip is None or clip == scene.active_clip:
        return
    scene.active_clip = clip
    if clip.frame_duration and all(clip.size):
        footage = footage_of(scene, take)
        # Blender forgets the rate of a clip whose file is missing, and images have none of their own.
        rate = take.clip_state.rate or footage.rate
        size = (clip.size[0], clip.size[1])
        set_scene_range(scene, size, rate, footage.first_frame, clip.frame_duration)
        scene.frame_current = min(max(scene.frame_current, scene.frame_start), scene.frame_end)


def _select(scene: Scene, armature_object: Object | None) -> None:
    layer = bpy.context.view_layer
    if armature_object is None or bpy.context.scene != scene or armature_object.name not in layer.objects:
        return
    before = layer.objects.active
    if before == armature_object or (before is not None and before.mode != "OBJECT"):
        return
    for chosen in list(layer.objects.selected):
        chosen.select_set(False)
    armature_object.select_set(True)
    layer.objects.active = armature_object


def assigned_tracks(take: PropertyGroup) -> tuple[AssignedTrack, ...]:
    """The motion tracks of a take's clip that follow a body point."""
    tracks = [(owner, track.name) for owner, track in clip_tracks(take.clip)] if take.clip is not None else []
    points = [(owner, name, point_of(take, owner, name)) for owner, name in tracks]
    return tuple(AssignedTrack(*each) for each in points if each[-1])


def point_of(take: PropertyGroup, owner: str, track: str) -> str:
    """The body point that a motion track follows; empty for none."""
    choices = {(choice.owner, choice.track): choice.point for choice in take.follow.tracks}
    return choices.get((owner, track), named_point(track) or "")


FOOTAGE_EDITORS = ("VIEW_3D", "CLIP_EDITOR")


def areas(context: Context, *kinds: str) -> Iterator[Area]:
    """Yield the areas of these kinds in all windows."""
    for window in context.window_manager.windows:
        yield from (area for area in window.screen.areas if area.type in kinds)


def redraw_editors(context: Context, *kinds: str) -> None:
    """Redraw every editor of these kinds."""
    for area in areas(context, *kinds):
        area.tag_redraw()


def redraw_footage(context: Context) -> None:
    """Redraw every editor that can show footage."""
    redraw_editors(context, *FOOTAGE_EDITORS)


def redraw_sidebars(context: Context) -> None:
    """Redraw the sidebars, which show a job's progress."""
    for area in areas(context, *FOOTAGE_EDITORS):
        for region in area.regions:
            if region.type == "UI":
                region.tag_redraw()


def redraw_sidebars_soon() -> None:
    """Redraw the sidebars after the next drawing: Blender moves sub-panels under a changed one only then."""
    if not bpy.app.background and not timers.is_registered(_redraw_once):
        timers.register(_redraw_once, first_interval=0.1)


def refresh_asset_browsers(context: Context) -> None:
    """Reload the assets and catalogs of open asset browsers."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.ui_type == "ASSETS":
                with context.temp_override(window=window, area=area):
                    if bpy.ops.asset.library_refresh.poll():
                        bpy.ops.asset.library_refresh()


def _redraw_once() -> None:
    redraw_sidebars(bpy.context)


NO_GUESS = (0.0, 0.0, 0.0)  # height, tilt and roll of a take whose camera was not put anywhere by guess


def as_numbers(placement: CameraPlacement) -> tuple[float, float, float]:
    """Height [m], tilt and roll [rad]."""
    return placement.height_m, placement.tilt_rad, placement.roll_rad
