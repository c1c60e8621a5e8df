"""The networks calculate what TensorFlow Lite calculates of the same weights."""

import numpy as np
import pytest
from keymark.core.detect.network_file import FOLDER, network_session

# What TensorFlow Lite gives for `waves`: every so manieth number of each output.
RESULTS = {
    "face": (
        192,
        {
            "conv2d_21": (
                156,
                (93.93436, 50.5026, 44.6269, 36.47473, 89.21159, 134.71127, 101.83651, 144.69585, 148.39798),
            ),
            "conv2d_31": (1, (-8.9378,)),
        },
    ),
    "hand": (
        224,
        {
            "Identity": (9, (113.89589, 111.31542, 112.40765, 112.08187, 110.86969, 109.23534, 113.87292)),
            "Identity_1": (1, (0.00183,)),
            "Identity_2": (1, (0.37598,)),
            "Identity_3": (9, (0.00537, 0.00766, -0.0018, -0.00591, -0.01571, -0.00143, -0.00153)),
        },
    ),
}


@pytest.mark.parametrize("part", RESULTS)
def test_stored_results(part: str) -> None:
    model = FOLDER / f"{part}_landmark.onnx"
    if not model.is_file():
        pytest.skip("tools/fetch_model.py was not run")
    side, results = RESULTS[part]
    y, x = np.mgrid[:side, :side] / side
    waves = np.stack([0.5 + 0.5 * np.sin(7 * x + 3 * y), 0.5 + 0.5 * np.cos(5 * y - 2 * x), x * y])
    session = network_session(model, part)
    found = session.run(list(results), {session.get_inputs()[0].name: waves[None].astype(np.float32)})
    for values, (every, expected) in zip(found, results.values(), strict=True):
        np.testing.assert_allclose(values.ravel()[::every], expected, atol=1e-3)
