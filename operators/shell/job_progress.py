"""How far the running job is; it lives in the window manager and is never saved."""

import bpy


class KEYMARK_PG_progress(bpy.types.PropertyGroup):
    """How far the running job is; shown only while one runs."""

    stage: bpy.props.StringProperty()
    fraction: bpy.props.FloatProperty(min=0.0, max=1.0)
    time_left: bpy.props.StringProperty()

    def show(self, stage: str, fraction: float, time_left: str = "") -> None:
        """Set all."""
        self.stage = stage
        self.fraction = fraction
        self.time_left = time_left


def register() -> None:
    """Add it to the window manager."""
    bpy.utils.register_class(KEYMARK_PG_progress)
    bpy.types.WindowManager.keymark_progress = bpy.props.PointerProperty(type=KEYMARK_PG_progress)


def unregister() -> None:
    """Take it away."""
    del bpy.types.WindowManager.keymark_progress
    bpy.utils.unregister_class(KEYMARK_PG_progress)
