"""Accuracy and speed of marker tracking, against the exactly visible pixels of rendered takes.

Run it from anywhere: `python benchmarks/extraction.py [TAKE ...]`; without takes, those of `shared/takes`
beside the repository. A take is a folder with take.json, its clip, and visibility.json (the markers' pixels
and centroids). The speed is that of the first take at 1280 x 720: enlarged, with noise added, once at its own
length and once played forward and backward. All times are processor times of one process with one thread.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
from clock import processor_time
from takes import ROOT, load_project

LARGE = (1280, 720)
MISSED_PIXELS = 30
LONG_FRAMES = 600
NOISE_LEVELS = 3.0
REPEATS = 5
LONG_REPEATS = 2


load_project()

from keymark.core.footage.clips.clip import Clip  # noqa: E402
from keymark.core.footage.colors.streaming_color_learning import StreamingColorLearner  # noqa: E402
from keymark.core.footage.marker_style import MarkerStyle  # noqa: E402
from keymark.core.footage.markers import track_markers  # noqa: E402
from keymark.core.footage.region_tracks import RegionTracks  # noqa: E402


def styles_of(take: Path) -> list[MarkerStyle]:
    """The markers of a take."""
    markers = json.loads((take / "take.json").read_text(encoding="utf-8"))["markers"]
    return [MarkerStyle(name, name, tuple(marker["color_srgb"])) for name, marker in markers.items()]


def extract(clip: Clip, styles: list[MarkerStyle]) -> RegionTracks:
    """Run the extraction to its end."""
    job = track_markers(clip, styles)
    while True:
        try:
            next(job)
        except StopIteration as stop:
            return stop.value


def quality_rows(take: Path) -> list[str]:
    """Table of the markers: errors, areas, misses and false regions, one line each."""
    start = time.process_time()
    tracks = extract(Clip.open(take / "clip.mp4"), styles_of(take))
    elapsed = time.process_time() - start
    size = f"{tracks.size[0]} x {tracks.size[1]}"
    rows = [f"{take.name}: {tracks.frame_count} frames of {size} in {elapsed:.2f} s"]
    return rows + marker_rows(tracks, take)


def marker_rows(tracks: RegionTracks, take: Path, scale: float = 1.0, left: float = 0.0) -> list[str]:
    """One line a marker, of the take's clip enlarged `scale` times and moved `left` pixels to the right."""
    truth = json.loads((take / "visibility.json").read_text(encoding="utf-8"))
    counts_only = truth.get("marker_pixels")
    rows = []
    for marker, name in enumerate(tracks.names):
        pixels = np.array(counts_only[name] if counts_only else truth[name]["pixels"])
        frames = len(pixels)
        seen = tracks.visible[:frames, marker]
        both = seen & (pixels > 0)
        ratio = tracks.area[:frames][both, marker] / pixels[both] / scale**2
        missed = np.count_nonzero(~seen & (pixels >= MISSED_PIXELS))
        false = np.count_nonzero(seen & (pixels == 0))
        error = "      -      -"
        if not counts_only:
            places = [place or [np.nan, np.nan] for place in truth[name]["centroid_px"]]
            offset = tracks.centroid[:frames, marker] - np.array(places, dtype=float) * scale - [left, 0.0]
            distance = np.linalg.norm(offset, axis=1)[both]
            error = f"{np.median(distance):7.2f}{np.quantile(distance, 0.95):7.2f}"
        rows.append(
            f"  {name:<12}{error}   {np.median(ratio):5.2f} {np.quantile(ratio, 0.05):5.2f} "
            f"{np.quantile(ratio, 0.95):5.2f}{missed:6d}{false:7d}   "
            f"{np.mean(tracks.quality[:frames][seen, marker]):.2f}"
        )
    return rows


def decode(path: Path) -> None:
    """Decode every frame."""
    capture = cv2.VideoCapture(str(path))
    while capture.read()[0]:
        pass
    capture.release()


class LearningTime:
    """Context manager that measures the learning of colors within the extraction."""

    def __enter__(self) -> "LearningTime":
        """Begin to measure."""
        self.seconds = 0.0
        self._learn = StreamingColorLearner._learn

        def learn(colors: StreamingColorLearner) -> None:
            self.seconds += processor_time(lambda: self._learn(colors))

        StreamingColorLearner._learn = learn
        return self

    def __exit__(self, *_: object) -> None:
        """Stop measuring."""
        StreamingColorLearner._learn = self._learn


def speed_rows(take: Path, frames: int, repeats: int) -> list[str]:
    """Processor time relative to decoding alone, and quality, with the take's clip enlarged to 1280 x 720."""
    styles = styles_of(take)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.mp4"
        scale, left = write_large(take / "clip.mp4", path, frames)
        decoding, extracting, learning = [], [], []
        for _ in range(repeats):  # alternately, since other load varies over time
            decoding.append(processor_time(lambda: decode(path)))
            with LearningTime() as learned:
                extracting.append(processor_time(lambda: extract(Clip.open(path), styles)))
            learning.append(learned.seconds)
        tracks = extract(Clip.open(path), styles)
    alone, total, learnt = (
        1000.0 * min(times) / tracks.frame_count for times in (decoding, extracting, learning)
    )
    return [
        f"{take.name}, {tracks.frame_count} frames: decoding {alone:.2f} ms a frame, extraction with it "
        f"{total:.2f} ms, {total / alone:.2f} times as much; {(total - learnt) / alone:.2f} times without "
        f"learning the colors, which takes {learnt:.2f} ms",
        *marker_rows(tracks, take, scale, left),
    ]


def write_large(source: Path, target: Path, frames: int) -> tuple[float, float]:
    """Write a clip enlarged, noisy, forward and backward; return its scale and the new left edge [px]."""
    images = [image for _, _, image in Clip.open(source).frames()]
    there_and_back = images + images[-2:0:-1]
    rng = np.random.default_rng(0)
    writer = cv2.VideoWriter(str(target), cv2.VideoWriter_fourcc(*"mp4v"), 30.0, LARGE)
    for index in range(frames or len(images)):
        image = fitted(there_and_back[index % len(there_and_back)])
        noise = rng.normal(0.0, NOISE_LEVELS, image.shape).astype(np.float32)
        writer.write(np.clip(image + noise, 0, 255).astype(np.uint8))
    writer.release()
    scale = min(LARGE[0] / images[0].shape[1], LARGE[1] / images[0].shape[0])
    return scale, float((LARGE[0] - round(scale * images[0].shape[1])) // 2)


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
        cv2.setNumThreads(1)
        print(f"\nAt {LARGE[0]} x {LARGE[1]}, processor time, and errors in its pixels:")
        print("\n".join(speed_rows(takes[0], 0, REPEATS)))
        print("\n".join(speed_rows(takes[0], LONG_FRAMES, LONG_REPEATS)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
