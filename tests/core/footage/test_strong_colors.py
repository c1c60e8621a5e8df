"""The colors that stand out in pictures, for a person who looks for the markers'."""

import numpy as np
from _synthetic_take import COLORS, drawn_frames, true_postures
from keymark.core.footage.colors.color_model import chromaticity
from keymark.core.footage.colors.strong_colors import StrongColor, strong_colors


def test_the_markers_are_among_the_strong_colors() -> None:
    found = strong_colors(drawn_frames(true_postures(6)))
    assert len(COLORS) <= len(found) <= 12
    colors = np.array([color.color_srgb for color in found], dtype=float)
    chroma = chromaticity(colors[:, ::-1])[0]
    for name, color in COLORS.items():
        wanted = chromaticity(np.array(color, dtype=float)[::-1])[0]
        assert np.linalg.norm(chroma - wanted, axis=1).min() < 0.08, name
    apart = np.linalg.norm(chroma[:, None] - chroma[None], axis=-1)[np.triu_indices(len(found), 1)]
    assert apart.min() > 0.03 and all(0.0 < color.share < 0.1 for color in found)


def test_of_gray_pictures_there_is_nothing_to_say() -> None:
    assert strong_colors([np.full((48, 64, 3), 90, dtype=np.uint8)]) == () == strong_colors([])


def test_hues_have_names() -> None:
    names = {(200, 30, 30): "red", (200, 30, 60): "red", (220, 190, 40): "yellow", (40, 150, 70): "green"}
    names |= {(50, 80, 220): "blue", (190, 50, 150): "pink", (120, 50, 160): "purple"}
    names |= {(220, 120, 50): "orange", (46, 98, 114): "cyan"}
    for color, name in names.items():
        assert StrongColor(color, 0.01).hue == name
