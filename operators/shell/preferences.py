"""The extension's preferences: which program finds keypoints, and how long it may take."""

import bpy

from ..bridge.detector.detector_command import parse_command
from ..bridge.detector.detector_setting import DEFAULT_TIME_LIMIT_S, Detector, environment_command

EXTENSION = __package__.removesuffix(".operators.shell")
"""The name that Blender knows the extension by."""
ORIGIN = "the detector of Keymark's preferences"
LONGEST_TIME_LIMIT_MIN = 7 * 24 * 60


class KEYMARK_AP_preferences(bpy.types.AddonPreferences):
    """Preferences of the extension."""

    bl_idname = EXTENSION

    detector: bpy.props.StringProperty(
        name="Detector",
        description=(
            "Command of a program that finds keypoints, as /path/to/python {detectors}/mediapipe_pose.py "
            "{clip} --output {output}. Words in braces are filled in: {clip} is the footage, {output} the "
            "file to write; put quotes around words with spaces. No shell runs it"
        ),
    )
    detector_minutes: bpy.props.IntProperty(
        name="Time Limit",
        description="Minutes after which a detector that is still running is stopped",
        default=round(DEFAULT_TIME_LIMIT_S / 60.0),
        min=1,
        max=LONGEST_TIME_LIMIT_MIN,
    )

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the preferences."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "detector")
        column.prop(self, "detector_minutes")


def preferences() -> KEYMARK_AP_preferences | None:
    """The preferences of the running Blender; None where Keymark runs without being enabled."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return None if addon is None else addon.preferences


def preferred_detector() -> Detector | None:
    """The detector that `KEYMARK_DETECTOR` or else the preferences name; None where neither does.

    Raises:
        InputError: Its command is unusable.
    """
    own = preferences()
    command = environment_command()
    if command is None and own is not None and own.detector.strip():
        command = parse_command(own.detector, ORIGIN)
    if command is None:
        return None
    return Detector(command, DEFAULT_TIME_LIMIT_S if own is None else 60.0 * own.detector_minutes)


def register() -> None:
    """Add the preferences."""
    bpy.utils.register_class(KEYMARK_AP_preferences)


def unregister() -> None:
    """Remove the preferences."""
    bpy.utils.unregister_class(KEYMARK_AP_preferences)
