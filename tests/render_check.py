"""Holds renders of an animated body against the footage, both seen by the project's own extraction.

What is compared is the whole way: footage to motion to armature to pixels. The front view shows errors across
the line of sight; the side view, which the estimate never saw, shows errors in depth.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from _drawn_clip import track_markers
from keymark.core.arrays import Array, BoolArray
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.progress import run, within
from keymark.core.take.take_file import read_take
from keymark.core.video.clip import Clip

STEP = 6
"""Every sixth frame is rendered; keyframes are among them by chance only."""
SHIFT = 10
"""A motion this many frames late must not pass."""
LEAST_AREA_SHARE = 0.4
"""Of the largest area that a marker has in the same images. Below it the marker is mostly hidden: the
remainder says where it is hidden, and for the far shin in the side view clutter of like hue stands in."""
DEMO = Path("presets") / "demo" / "aerobic"
KEYFRAMES = "keyframes_noisy.json"
"""Posed with a person's errors, as users' keyframes are."""


@dataclass(frozen=True)
class View:
    """A camera whose footage is compared."""

    name: str
    """`front` or `side`."""
    clip: str
    """Its footage in the take's folder."""
    median_px: float
    """Largest distance between a marker's two centroids for half of them [px]."""
    p95_px: float
    """The same for 95 % of them [px]."""
    least_share: float
    """Of all markers and rendered frames, how many must be compared: it must not pass because next to
    nothing was found."""

    def camera(self, take: Path, folder: Path) -> str:
        """What the renderer is told: the scene's own camera, or a file in `folder` with the side's."""
        if self.name == "front":
            return "scene"
        side = json.loads((take / "side.json").read_text(encoding="utf-8"))
        path = folder / "side_camera.json"
        path.write_text(json.dumps(side["camera"]), encoding="utf-8")
        return str(path)

    def accepts(self, found: Array) -> bool:
        """Whether distances [px] keep to both limits."""
        return bool(np.median(found) <= self.median_px and np.percentile(found, 95) <= self.p95_px)


# Measured with keyframes posed by hand: front median 1.6, p95 5.1 px; side 1.7 and 6.2 px; ten frames late
# 10 and 39, 5.5 and 39 px. The body drawn is plainer than the performer (its trunk begins at the hips:
# 4 to 5 px), a pixel is about 10 mm, and the estimate's depth error, which the side shows, 17 mm.
VIEWS = (View("front", "clip.mp4", 3.0, 8.0, 0.7), View("side", "side.mp4", 4.0, 12.0, 0.5))


def extract(clip: Path, take: Path) -> RegionTracks:
    """The take's markers in its video or in a folder with every `STEP`-th frame as an image."""
    read = read_take(take)
    job = within("Following", track_markers(Clip.open(clip, fps=read.fps), read.markers), 0.0, 1.0)
    return run(job)


def distances(rendered: RegionTracks, footage: RegionTracks, shift: int = 0) -> Array:
    """Distances (N,) [px] between the centroids of every marker and frame that both show.

    Args:
        rendered: From every `STEP`-th frame of the motion.
        footage: From every frame of the clip.
        shift: Compare with the footage so many frames later, as if the motion were late by as much.
    """
    index = STEP * np.arange(rendered.frame_count) + shift
    kept = index < footage.frame_count
    index = index[kept]
    both = _well_seen(rendered)[kept] & _well_seen(footage)[index]
    apart = np.linalg.norm(rendered.centroid[kept] - footage.centroid[index], axis=-1)
    return np.asarray(apart[both & np.isfinite(apart)])


def _well_seen(tracks: RegionTracks) -> BoolArray:
    """(F, M) whether a marker shows enough of itself."""
    area = np.nan_to_num(tracks.area)
    return np.asarray(area >= LEAST_AREA_SHARE * area.max(axis=0))


def assert_agreement(rendered: RegionTracks, take: Path, view: View) -> None:
    """Fail unless enough regions were found and their centroids agree within the view's tolerance."""
    found = distances(rendered, extract(take / view.clip, take))
    assert len(found) >= view.least_share * rendered.area.size, _summary(found)
    assert view.accepts(found), _summary(found)


def assert_lateness_fails(rendered: RegionTracks, take: Path, view: View) -> None:
    """Fail if the comparison would accept the motion `SHIFT` frames late."""
    found = distances(rendered, extract(take / view.clip, take), SHIFT)
    assert not view.accepts(found), _summary(found)


def _summary(found: Array) -> str:
    return f"median {np.median(found):.2f} px, p95 {np.percentile(found, 95):.2f} px, {len(found)} regions"
