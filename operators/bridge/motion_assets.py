"""Whole motions as Action assets, made without any armature.

The curves are those that `convert` writes: of an armature as Keymark builds it, at the world's origin, every
bone in the rotation mode it is built with. All its actors have the same bones, so that any of them can be
given any of these Actions.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.motion import Motion
from ...core.report.thumbnail import thumbnail
from .actions import new_channelbag
from .asset_blend import write_asset_blend
from .assets import AssetDetails, mark_action
from .bone_channels import channels_at_rest
from .bones import bone_models, rest_matrices, usual_mode
from .fcurves import channel_columns
from .frame_times import scene_frames
from .keys import add_generated_keys
from .object_space import AT_ORIGIN


@dataclass(frozen=True, eq=False)
class MotionAsset:
    """A motion, and what an asset browser shows of it."""

    name: str
    catalog: str
    """Path of its catalog, with slashes."""
    description: str
    tags: tuple[str, ...]
    motion: Motion


def add_motion_asset(data: bpy.types.BlendData, asset: MotionAsset) -> bpy.types.Action:
    """Add an Action with a motion, marked as asset, to a file.

    Args:
        data: The file.
        asset: The motion, with what is said of it; its catalog is the caller's to enter.
    """
    action = data.actions.new(asset.name)
    write_motion_curves(action, asset.motion)
    details = AssetDetails("", asset.tags, author="", license="", description=asset.description)
    mark_action(action, details, thumbnail(asset.motion))
    return action


def write_motion_curves(action: bpy.types.Action, motion: Motion) -> None:
    """Give an empty Action the curves of a motion: a key for each frame and channel, of type GENERATED."""
    channelbag = new_channelbag(action)
    body, skeleton = motion.body, motion.body.skeleton
    models = bone_models(body)
    modes = {model.name: usual_mode(skeleton, model) for model in models}
    frames = scene_frames(motion.time_s, motion.frame_start, motion.fps)
    channels = channels_at_rest(models, rest_matrices(body), AT_ORIGIN, motion.posture)
    for path, index, bone, column in channel_columns(channels, modes.__getitem__):
        add_generated_keys(channelbag, path, index, bone, frames, column)
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frames[0]), float(frames[-1])


def write_motion_library(path: Path, assets: Iterable[MotionAsset]) -> None:
    """Write motions as Action assets into a .blend, and their catalogs into the file beside it.

    Args:
        path: The .blend; one that is there is replaced, while catalogs that are there are kept.
        assets: Taken one at a time.

    Raises:
        InputError: As `write_asset_blend`.
        ConversionError: As `write_asset_blend`.
    """

    def add(data: bpy.types.BlendData) -> Iterator[tuple[bpy.types.Action, str]]:
        for asset in assets:
            yield add_motion_asset(data, asset), asset.catalog

    write_asset_blend(path, path.parent, add)
