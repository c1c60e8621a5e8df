"""A motion marked as an asset with the details that the animator entered."""

import bpy

from ..bridge.assets.catalogs import catalog_file, ensure_catalog
from ..shell.redraw import refresh_asset_browsers


def mark_motion_asset(
    context: bpy.types.Context,
    take: bpy.types.PropertyGroup,
    action: bpy.types.Action,
    pictured: bpy.types.Action | None,
    actor: bpy.types.Object | None = None,
) -> None:
    """Add the catalog to its file, then mark an Action.

    Args:
        context: Its asset browsers are refreshed.
        take: The take, whose details of the finish are the asset's.
        action: The Action to mark.
        pictured: The actor's Action that the picture is drawn from; None keeps the present picture.
        actor: The actor that it moves; the take's by default.

    Raises:
        InputError: The catalog is unusable, or the pictured Action is not the actor's.
        ConversionError: The catalog cannot be written.
    """
    from ..bridge.assets.marking import AssetDetails, action_picture, mark_asset

    settings, performer = take.finish, actor or take.armature
    picture = None
    if pictured is not None and performer is not None:
        picture = action_picture(context.scene, performer, pictured)
    catalog = ensure_catalog(catalog_file(), settings.catalog) if settings.catalog.strip() else ""
    tags = [tag.strip() for tag in settings.tags.split(",") if tag.strip()]
    details = AssetDetails(catalog, tags, settings.author, settings.license, settings.description)
    mark_asset(action, details, picture)
    refresh_asset_browsers(context)
