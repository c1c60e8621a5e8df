"""The page of a batch, in a browser: takes made from the demonstration, some of them in need of work."""

import json
import shutil
import subprocess
from contextlib import chdir, redirect_stderr
from io import StringIO
from pathlib import Path

import cv2
import numpy as np
from keymark.core.arrays import Image
from keymark.operators.cli.main import main as keymark

from .results import DEMO, KEYFRAMES

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
SIZE = (1300, 1000)
SHOOT, MOTIONS = "autumn", "motions"
PATIENCE_S = 120
CUT = 0.4
"""Share that is left of the file of a take whose recording was cut off."""
TAKES: dict[str, tuple[dict[str, object], int | None]] = {
    "day 1/exercise": ({"evidence": ["markers", "contours"]}, 1),
    "day 1/exercise in plain clothes": (
        {"markers": None, "evidence": ["keypoints", "depth_hints", "contours"]},
        1,
    ),
    "day 2/half the keyframes": ({"evidence": ["markers", "contours"]}, 2),
    "day 2/first and last frame posed": ({"evidence": ["contours"], "markers": None}, 11),
    "day 3/nobody posed it": ({"evidence": ["markers", "contours"], "library": "aerobic"}, None),
}
"""By name: fields that differ from the demonstration's, and that of its keyframes every n-th is kept."""
CUT_OFF = "day 3/recorder stopped"


def draw_batch_page(folder: Path) -> Image:
    """Convert a small shoot, and take a picture of its page.

    Raises:
        SystemExit: There is no browser, or it shows nothing.
    """
    browser = next((found for found in map(shutil.which, BROWSERS) if found), None)
    if browser is None:
        raise SystemExit(f"batch_summary.jpg: no browser is here; install one of {', '.join(BROWSERS)}")
    shoot, output = folder / SHOOT, folder / MOTIONS
    for made in (shoot, output):
        shutil.rmtree(made, ignore_errors=True)
    for name, (fields, every) in TAKES.items():
        _write_take(shoot / name, fields, every)
    _write_take(shoot / CUT_OFF, {}, 1)
    clip = shoot / CUT_OFF / "clip.mp4"
    clip.write_bytes(clip.read_bytes()[: int(CUT * clip.stat().st_size)])
    # From the folder itself, so that the page names files as a user would; the take that fails is meant to.
    with chdir(folder), redirect_stderr(StringIO()):
        keymark(["batch", SHOOT, "--output", MOTIONS, "--jobs", "1", "--quiet"])
    picture = folder / "page.png"
    picture.unlink(missing_ok=True)
    words = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--hide-scrollbars",
        "--force-device-scale-factor=1",
    ]
    words += [f"--window-size={SIZE[0]},{SIZE[1]}", f"--screenshot={picture}"]
    subprocess.run(
        [browser, *words, (output / "summary.html").as_uri()],
        capture_output=True,
        timeout=PATIENCE_S,
        check=False,
    )
    image = cv2.imread(str(picture))
    if image is None:
        raise SystemExit(f"batch_summary.jpg: {browser} made no picture of {output / 'summary.html'}")
    return np.asarray(image, dtype=np.uint8)


def _write_take(folder: Path, fields: dict[str, object], every: int | None) -> None:
    """A take of the demonstration's footage; without keyframes if `every` is None."""
    folder.mkdir(parents=True)
    for name in ("clip.mp4", "keypoints.json"):
        shutil.copyfile(DEMO / name, folder / name)
    described = json.loads((DEMO / "take.json").read_text(encoding="utf-8"))
    kept = {name: value for name, value in {**described, **fields}.items() if value is not None}
    (folder / "take.json").write_text(json.dumps(kept), encoding="utf-8")
    if every is not None:
        keyframes = json.loads(KEYFRAMES.read_text(encoding="utf-8"))
        keyframes["keyframes"] = keyframes["keyframes"][::every]
        (folder / "keyframes.json").write_text(json.dumps(keyframes), encoding="utf-8")
