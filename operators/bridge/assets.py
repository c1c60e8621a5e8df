"""Data-blocks marked as assets: catalog, tags, details and preview; motions as assets."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import cv2
import numpy as np
from bpy.types import ID, Action, Object, Scene

from ...core.arrays import Image
from ...core.errors import InputError
from ...core.feet.natural_extremities import natural_extremities
from ...core.report.mannequin import posture_picture
from ...core.take.motion import Motion
from .actions import action_digest, assign_action, channelbag_for
from .armature import bones_at_rest, build_armature
from .asset_catalogs import write_asset_blend
from .blend_files import check_blend, load_blocks, own_scene
from .fcurves import posture_columns
from .keys import MOTION, write_keys
from .scene_frames import scene_frames


@dataclass(frozen=True)
class AssetDetails:
    """Details of an asset, as the asset browser shows them."""

    catalog: str  # UUID of its catalog; empty for none
    tags: Sequence[str]
    author: str
    license: str
    description: str


def mark_asset(asset: ID, details: AssetDetails, picture: Image | None) -> None:
    """Mark a data-block as an asset, with a preview (S, S, 3), blue, green, red, or the one that it has."""
    asset.asset_mark()
    data = asset.asset_data
    if details.catalog:
        data.catalog_id = details.catalog
    data.author, data.license = details.author, details.license
    data.description = details.description
    for tag in list(data.tags):
        data.tags.remove(tag)
    for name in details.tags:
        data.tags.new(name, skip_if_exists=True)
    if picture is not None:  # Blender keeps it from the bottom row up, red, green, blue, alpha from 0 to 1
        rgba = cv2.cvtColor(picture, cv2.COLOR_BGR2RGBA)[::-1].astype(np.float32) / 255.0
        preview = asset.preview_ensure()
        preview.image_size = (picture.shape[1], picture.shape[0])
        preview.image_pixels_float.foreach_set(np.ascontiguousarray(rgba).ravel())


@dataclass(frozen=True, eq=False)
class MotionAsset:
    """A motion with its details for the asset browser."""

    name: str
    catalog: str  # path of its catalog below that of its kind, with slashes
    description: str
    tags: tuple[str, ...]
    motion: Motion
    action: Action | None = None  # of a character, made from the motion


def load_character_action(blend: Path, name: str, curves: str) -> Action:
    """Append a character's Action out of a character.blend; InputError where it is not that of the digest."""
    check_blend(blend, "a character")
    advice = "convert the take again"
    found = load_blocks(blend, "actions", advice, lambda names: [one for one in names if one == name])
    if not found:
        raise InputError(f"{blend}: lacks its Action; {advice}")
    if action_digest(found[0]) != curves:
        raise InputError(f"{blend}: is not the file that the conversion wrote; {advice}")
    return found[0]


MOTIONS, ACTORS, CHARACTERS = "Keymark", "Keymark Actors", "Keymark Characters"
"""Parents of the catalogs of all shoots."""


def write_motion_library(path: Path, assets: Iterable[MotionAsset]) -> None:
    """Write motions into a .blend: as Actions, and as actors, which alone can be dragged from a browser."""
    with own_scene("Motions") as scene:
        write_asset_blend(path, path.parent, bpy.data, _motion_assets(scene, assets))


def _motion_assets(scene: Scene, assets: Iterable[MotionAsset]) -> Iterator[tuple[ID, str]]:
    """The Action and the actor of each motion, with their catalogs; motions of one body share an armature."""
    actors: dict[tuple[tuple[str, float], ...], Object] = {}
    for asset in assets:
        motion = asset.motion.without_absence()
        picture = posture_picture(motion.body, motion.posture[len(motion.time_s) // 2])
        details = AssetDetails("", asset.tags, author="", license="", description=asset.description)
        action = asset.action or bpy.data.actions.new(asset.name)
        mark_asset(action, details, picture)
        if asset.action is not None:
            action.name = asset.name
            yield action, f"{CHARACTERS}/{asset.catalog}"
            continue
        frames = scene_frames(motion.time_s, motion.frame_start, motion.fps)
        extremities = natural_extremities(motion.body, motion.posture, motion.time_s, hands=motion.hands)
        columns = posture_columns(bones_at_rest(motion.body), motion.posture, extremities)
        write_keys(channelbag_for(action), columns, frames, MOTION)
        action.use_frame_range = True
        action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])
        yield action, f"{MOTIONS}/{asset.catalog}"
        body = asset.motion.body
        lengths = tuple(sorted(body.actor.segments_m.items()))
        if lengths not in actors:
            actors[lengths] = build_armature(scene, body)
        actor = actors[lengths].copy()
        actor.name = asset.name
        assign_action(actor, action)
        mark_asset(actor, details, picture)
        yield actor, f"{ACTORS}/{asset.catalog}"
