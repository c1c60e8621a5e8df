"""How far the running job is; it lives in the window manager and is never saved."""

import bpy


class KEYMARK_PG_progress(bpy.types.PropertyGroup):
    """How far the running job is; shown only while one runs."""

    stage: bpy.props.StringProperty()
    fraction: bpy.props.FloatProperty(min=0.0, max=1.0)

    def show(self, stage: str, fraction: float) -> None:
        """Set both."""
        self.stage = stage
        self.fraction = fraction


def register() -> None:
    """Add it to the window manager."""
    bpy.utils.register_class(KEYMARK_PG_progress)
    bpy.types.WindowManager.keymark_progress = bpy.props.PointerProperty(type=KEYMARK_PG_progress)


def unregister() -> None:
    """Take it away."""
    del bpy.types.WindowManager.keymark_progress
    bpy.utils.unregister_class(KEYMARK_PG_progress)
