"""Colors along limbs."""

import numpy as np
from keymark.core.footage.surface_colors import BANDS, BandColors, band_cells, learn_band_colors

SLEEVE, SKIN = np.array([180, 60, 40], dtype=np.uint8), np.array([120, 150, 210], dtype=np.uint8)


def learn() -> BandColors:
    image = np.full((40, 60, 3), 90, dtype=np.uint8)
    label = np.full((40, 60), -1, dtype=np.int8)
    share = np.full((40, 60), np.nan)
    for part, top in enumerate((5, 22)):
        label[top : top + 10] = part
        share[top : top + 10] = np.linspace(-0.1, 1.1, 60)
        image[top : top + 10] = np.where((share[top, :, None] < 2 / 3), SLEEVE, SKIN)
    return learn_band_colors([image], [label], [share], 2)


def test_each_band_has_the_colors_worn_there() -> None:
    bands = learn().bands[0]
    sleeve, skin = bands[:, band_cells(SLEEVE)], bands[:, band_cells(SKIN)]
    assert (sleeve[: 2 * BANDS // 3] > skin[: 2 * BANDS // 3] + 0.5).all()
    assert (skin[2 * BANDS // 3 :] > sleeve[2 * BANDS // 3 :] + 0.5).all()


def test_densities_sum_to_one() -> None:
    learned = learn()
    for logs in (learned.bands, learned.parts, learned.anything):
        np.testing.assert_allclose(np.exp(logs).sum(axis=-1), 1.0, rtol=1e-6)
