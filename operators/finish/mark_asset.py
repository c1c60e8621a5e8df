"""Mark a take's motion as an asset."""

import bpy

from ..bridge.assets.catalogs import catalog_file, ensure_catalog
from ..shell.base_operator import BaseOperator
from ..shell.messages import say, warn_if_outdated
from ..shell.redraw import refresh_asset_browsers
from ..shell.requirements import actor, idle, motion
from ..shell.takes import active_take


class KEYMARK_OT_mark_asset(BaseOperator, bpy.types.Operator):
    """Mark the motion, the final Action if there is one, as an asset with catalog, tags and picture"""

    bl_idname = "keymark.mark_asset"
    bl_label = "Mark Asset"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (actor, motion, idle)

    def run(self, context: bpy.types.Context) -> None:
        """Add the catalog to its file, then mark the Action."""
        from ..bridge.assets.marking import AssetDetails, action_picture, mark_asset

        take = active_take(context.scene)
        settings, action = take.finish, take.finish.action or take.motion_action
        picture = action_picture(context.scene, take.armature, action)
        catalog = ensure_catalog(catalog_file(), settings.catalog) if settings.catalog.strip() else ""
        tags = [tag.strip() for tag in settings.tags.split(",") if tag.strip()]
        details = AssetDetails(catalog, tags, settings.author, settings.license, settings.description)
        mark_asset(action, details, picture)
        refresh_asset_browsers(context)
        warn_if_outdated(self, take)
        say(self, "INFO", "'{action}' is an asset now; save the .blend to keep it", action=action.name)


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_mark_asset,))
