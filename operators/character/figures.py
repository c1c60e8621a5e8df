"""What was measured of a retargeted motion, in a few plain lines."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core.retarget.quality import Quality


def figures(quality: "Quality") -> list[str]:
    """Lines on feet, floor, hands (or limbs, where the hands reach nothing) and keys."""
    lines = []
    if quality.skate_mm is not None:
        lines.append(f"Feet slide {quality.skate_mm:.2f} mm a frame")
    if quality.penetration_mm is not None:
        lines.append(f"Soles at most {quality.penetration_mm:.1f} mm below floor")
    if quality.hands_mm is not None:
        lines.append(f"Hands {quality.hands_mm:.0f} mm from what they reach")
    elif quality.arms_deg is not None and quality.legs_deg is not None:
        lines.append(f"Arms {quality.arms_deg:.1f}°, legs {quality.legs_deg:.1f}° off")
    if quality.keys is not None and quality.dense_keys is not None:
        lines.append(f"{quality.keys} keys instead of {quality.dense_keys}")
    return lines
