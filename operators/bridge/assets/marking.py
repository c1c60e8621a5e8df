"""Mark data-blocks as assets: catalog, tags, details and preview for the asset browser."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import cv2
import numpy as np

from ....core.arrays import Image
from ....core.report.stick_figure import thumbnail
from ..rig import shown_motion


@dataclass(frozen=True)
class AssetDetails:
    """Details of an asset, as the asset browser shows them."""

    catalog: str  # UUID of its catalog; empty for none
    tags: Sequence[str]
    author: str
    license: str
    description: str


def mark_asset(asset: bpy.types.ID, details: AssetDetails, picture: Image | None) -> None:
    """Mark a data-block as an asset, or change an asset's details; its tags are replaced.

    `picture` (S, S, 3), blue, green, red, is its preview; None keeps the present one.
    """
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


def action_picture(
    scene: bpy.types.Scene, armature_object: bpy.types.Object, action: bpy.types.Action
) -> Image:
    """A small picture of the motion an Action holds for an actor, (256, 256, 3) blue, green, red."""
    return thumbnail(shown_motion(scene, armature_object, action, most_frames=25))
