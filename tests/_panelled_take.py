"""The demonstration with a panel of a sleeve's color on its wall, which nobody wears."""

import json
import shutil
from pathlib import Path

import cv2
from keymark.core.video.clip import Clip

PANEL = (8, 60, 60, 150)
"""Left, top, right, bottom in pixels of the demonstration, beside the performer."""
SLEEVE = "forearm.L"


def panelled_take(demo: Path, folder: Path) -> Path:
    """Write the demonstration anew as images; returns the take's folder."""
    fields = json.loads((demo / "take.json").read_text(encoding="utf-8"))
    (folder / "frames").mkdir(parents=True)
    left, top, right, bottom = PANEL
    for index, _, image in Clip.open(demo / "clip.mp4").frames():
        image[top:bottom, left:right] = fields["markers"][SLEEVE]["color_srgb"][::-1]
        cv2.imwrite(str(folder / "frames" / f"{index + 1:04d}.png"), image)
    for name in ("keyframes.json", "truth.json"):
        shutil.copy(demo / name, folder)
    fields["clip"] = "frames"
    (folder / "take.json").write_text(json.dumps(fields), encoding="utf-8")
    return folder
