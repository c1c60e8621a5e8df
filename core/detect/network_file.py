"""The files of networks, which `tools/fetch_model.py` puts there: checked, and made ready for onnxruntime."""

import hashlib
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from ..arrays import Array, Image, SingleArray
from ..errors import InputError

FOLDER = Path(__file__).resolve().parents[2] / "presets" / "models"
CHECKSUMS = FOLDER / "SHA256SUMS"


def network_session(model: Path, finds: str) -> Any:
    """An onnxruntime session on one thread, for several looks at once; `finds` says what, for sentences.

    Raises:
        InputError: The file is missing, damaged or another one, or onnxruntime cannot be loaded.
    """
    again = "install Keymark's zip again, or run tools/fetch_model.py in a copy of its source"
    try:
        weights = model.read_bytes()
    except OSError as error:
        raise InputError(
            f"{model}: the network that finds {finds} cannot be read ({error.strerror}); {again}"
        ) from error
    known = [line.split()[0] for line in CHECKSUMS.read_text(encoding="utf-8").splitlines()]
    if hashlib.sha256(weights).hexdigest() not in known:
        raise InputError(f"{model}: the network that finds {finds} is damaged or another one; {again}")
    return open_session(weights, finds)


def open_session(weights: bytes, finds: str) -> Any:
    """The session of a network's file; its own errors where that is damaged."""
    try:
        import onnxruntime
    except ImportError as error:
        raise InputError(
            f"onnxruntime, which runs the network that finds {finds}, cannot be loaded ({error}); install "
            "Keymark's zip for this Blender again"
        ) from error
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 4
    return onnxruntime.InferenceSession(
        weights, options, providers=["CPUExecutionProvider"], enable_fallback=0
    )


def network_input(
    picture: Image, matrix: Array, side: int, height: int | None = None, border: int = cv2.BORDER_REPLICATE
) -> SingleArray:
    """A network's input (1, 3, side, side), red first, 0 to 1, of a picture (height, width, 3), blue first.

    `matrix` (2, 3) leads from the input's pixels to the picture's, both with their origin at outer corners;
    `height` is the input's where it is no square, `border` OpenCV's way beyond the picture.
    """
    centers = matrix.copy()
    centers[:, 2] += matrix[:, :2] @ np.full(2, 0.5) - 0.5  # OpenCV counts from the middle of a pixel
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (side, height or side)
    seen = cv2.warpAffine(picture, centers, size, flags=flags, borderMode=border)
    return np.asarray(cv2.dnn.blobFromImage(seen, 1.0 / 255.0, swapRB=True), dtype=np.float32)
