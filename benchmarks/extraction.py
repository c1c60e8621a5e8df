"""How well and how fast the markers are found: against the exactly visible pixels of rendered takes.

Run it from anywhere: `python benchmarks/extraction.py [TAKE ...]`; without takes, those of `shared/takes`
beside the repository. A take is a folder with take.json, its clip, and visibility.json (the markers' pixels
and centroids).
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
from clock import least_time
from takes import ROOT, load_project

LARGE = (1280, 720)
MISSED_PIXELS = 30


load_project()

from keymark.core.footage.clip import Clip  # noqa: E402
from keymark.core.footage.markers import MarkerStyle, learn_model, track_markers  # noqa: E402
from keymark.core.footage.regions import find_regions  # noqa: E402
from keymark.core.footage.tracks import RegionTracks  # noqa: E402


def styles_of(take: Path) -> list[MarkerStyle]:
    """The markers that a take names."""
    markers = json.loads((take / "take.json").read_text(encoding="utf-8"))["markers"]
    return [MarkerStyle(name, name, tuple(marker["color_srgb"])) for name, marker in markers.items()]


def extract(clip: Clip, styles: list[MarkerStyle]) -> RegionTracks:
    """Drive the extraction to its end."""
    job = track_markers(clip, styles)
    while True:
        try:
            next(job)
        except StopIteration as stop:
            return stop.value


def quality_rows(take: Path) -> list[str]:
    """One line a marker: errors, areas, misses and false regions."""
    truth = json.loads((take / "visibility.json").read_text(encoding="utf-8"))
    start = time.perf_counter()
    tracks = extract(Clip.open(take / "clip.mp4"), styles_of(take))
    elapsed = time.perf_counter() - start
    rows = [
        f"{take.name}: {tracks.frame_count} frames of {tracks.size[0]} x {tracks.size[1]} in {elapsed:.2f} s"
    ]
    counts_only = truth.get("marker_pixels")
    for marker, name in enumerate(tracks.names):
        pixels = np.array(counts_only[name] if counts_only else truth[name]["pixels"])
        seen = tracks.visible[:, marker]
        both = seen & (pixels > 0)
        ratio = tracks.area[both, marker] / pixels[both]
        missed = np.count_nonzero(~seen & (pixels >= MISSED_PIXELS))
        false = np.count_nonzero(seen & (pixels == 0))
        error = "      -      -"
        if not counts_only:
            places = [place or [np.nan, np.nan] for place in truth[name]["centroid_px"]]
            distance = np.linalg.norm(tracks.centroid[:, marker] - np.array(places, dtype=float), axis=1)[
                both
            ]
            error = f"{np.median(distance):7.2f}{np.quantile(distance, 0.95):7.2f}"
        rows.append(
            f"  {name:<12}{error}   {np.median(ratio):5.2f} {np.quantile(ratio, 0.05):5.2f} "
            f"{np.quantile(ratio, 0.95):5.2f}{missed:6d}{false:7d}   "
            f"{np.mean(tracks.quality[seen, marker]):.2f}"
        )
    return rows


def speed_row(take: Path) -> str:
    """Processor time over decoding alone, of the take's clip enlarged to 1280 x 720."""
    styles = styles_of(take)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.mp4"
        writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 30.0, LARGE)
        for _, _, image in Clip.open(take / "clip.mp4").frames():
            writer.write(fitted(image))
        writer.release()
        clip = Clip.open(path)
        model = learn_model(clip, styles)
        learning = least_time(lambda: learn_model(clip, styles))
        decoding = least_time(lambda: [index for index, _, _ in clip.frames()])
        finding = least_time(lambda: [len(find_regions(image, model)) for _, _, image in clip.frames()])
        frames = clip.frame_count
    return (
        f"{take.name}: decoding {1000 * decoding / frames:.2f} ms a frame, with finding the markers "
        f"{1000 * finding / frames:.2f} ms, {finding / decoding:.2f} times as much; "
        f"learning once {learning:.2f} s"
    )


def fitted(image: np.ndarray) -> np.ndarray:
    """Enlarge an image to fill 1280 x 720, its edges repeated at the sides."""
    scale = min(LARGE[0] / image.shape[1], LARGE[1] / image.shape[0])
    large = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    across, down = LARGE[0] - large.shape[1], LARGE[1] - large.shape[0]
    sides = (down // 2, down - down // 2, across // 2, across - across // 2)
    return cv2.copyMakeBorder(large, *sides, cv2.BORDER_REPLICATE)


def main(argv: list[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("takes", nargs="*", type=Path, metavar="TAKE", help="folders of takes")
    parser.add_argument("--no-speed", action="store_true", help="leave out the measurement at 1280 x 720")
    arguments = parser.parse_args(argv)
    beside = ROOT.parent / "shared" / "takes"
    takes = arguments.takes or sorted(path.parent for path in beside.glob("*/visibility.json"))
    if not takes:
        print(f"no take given and none in {beside}")
        return 0
    print("                error in px      area / visible pixels")
    print("  marker       median    95%  median    5%   95%  missed  false  quality")
    for take in takes:
        print("\n".join(quality_rows(take)))
    if not arguments.no_speed:
        print(f"\nAt {LARGE[0]} x {LARGE[1]}, processor time:")
        print(speed_row(takes[0]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
