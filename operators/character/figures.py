"""What was measured of a retargeted motion, in a few plain lines."""

from typing import TYPE_CHECKING

from ..shell.messages import label

if TYPE_CHECKING:
    from ...core.retarget.quality import Quality


def figures(quality: "Quality") -> list[str]:
    """Lines on feet, floor, hands (or limbs, where the hands reach nothing) and keys."""
    lines = []
    if quality.skate_mm is not None:
        lines.append(label("Feet slide {way:.2f} mm a frame", way=quality.skate_mm))
    if quality.penetration_mm is not None:
        lines.append(label("Soles at most {depth:.1f} mm below floor", depth=quality.penetration_mm))
    if quality.hands_mm is not None:
        lines.append(label("Hands {distance:.0f} mm from what they reach", distance=quality.hands_mm))
    elif quality.arms_deg is not None and quality.legs_deg is not None:
        lines.append(
            label("Arms {arms:.1f}°, legs {legs:.1f}° off", arms=quality.arms_deg, legs=quality.legs_deg)
        )
    if quality.keys is not None and quality.dense_keys is not None:
        lines.append(label("{keys} keys instead of {dense}", keys=quality.keys, dense=quality.dense_keys))
    return lines
