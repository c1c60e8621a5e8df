"""A reading as named arrays of numbers and text, and back: its form in the cache.

Names of arrays stay as they are, so that stored readings can be loaded.
"""

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clips.album import Album
from .clips.frame_checks import FrameFindings
from .detections import Detections, LearningRound
from .reading import Reading
from .region_tracks import RegionTracks
from .segmentation.regions import Regions

Arrays = dict[str, NDArray[Any]]

TRACKED = ("centroid", "second_moment", "area", "quality", "clipped", "time_s")


def reading_arrays(reading: Reading) -> Arrays:
    """A reading as arrays by name."""
    tracks, findings = reading.tracks, reading.frame_findings
    arrays: Arrays = {f"tracks.{name}": getattr(tracks, name) for name in TRACKED}
    arrays |= {
        "key": np.array(reading.key),
        "notes": _text(reading.notes),
        "noticed.blank": np.array(findings.blank, dtype=np.int64),
        "noticed.cuts": np.array(findings.cuts, dtype=np.int64),
        "noticed.rest": np.array([findings.frames, findings.interlaced], dtype=np.int64),
        "tracks.names": _text(tracks.names),
        "tracks.notes": _text(tracks.notes),
        "tracks.size": np.array(tracks.size),
    }
    if reading.album is not None:
        arrays |= {f"album.{name}": array for name, array in reading.album.to_arrays().items()}
    if reading.detections is not None:
        arrays |= {f"seen.{name}": array for name, array in _detections_arrays(reading.detections).items()}
    return arrays


def reading_from_arrays(arrays: Mapping[str, NDArray[Any]]) -> Reading:
    """The reading that `reading_arrays` gave as arrays.

    Raises:
        KeyError, ValueError: They are not of a reading.
    """
    width, height = arrays["tracks.size"].tolist()
    tracks = RegionTracks(
        names=tuple(arrays["tracks.names"].tolist()),
        size=(width, height),
        notes=tuple(arrays["tracks.notes"].tolist()),
        **{name: arrays[f"tracks.{name}"] for name in TRACKED},
    )
    album = Album.from_arrays(_under("album", arrays)) if "album.picture" in arrays else None
    seen = _detections(_under("seen", arrays), tracks) if "seen.start" in arrays else None
    frames, interlaced = arrays["noticed.rest"].tolist()
    blank, cuts = (tuple(arrays[f"noticed.{name}"].tolist()) for name in ("blank", "cuts"))
    findings = FrameFindings(frames, blank, cuts, bool(interlaced))
    return Reading(tracks, album, seen, tuple(arrays["notes"].tolist()), str(arrays["key"]), findings)


def _under(name: str, arrays: Mapping[str, NDArray[Any]]) -> Arrays:
    return {
        key.removeprefix(f"{name}."): array for key, array in arrays.items() if key.startswith(f"{name}.")
    }


def _text(lines: tuple[str, ...]) -> NDArray[Any]:
    return np.array(lines, dtype=np.str_) if lines else np.zeros(0, dtype="<U1")


def _detections_arrays(seen: Detections) -> Arrays:
    """Concatenated regions with the index of each frame's first one; learning rounds likewise."""
    counts = [len(found.color) for found in seen.regions]
    learned = [len(one.frames) for one in seen.learning_rounds]
    frames = sorted(seen.samples)
    return {
        "start": np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        **{name: np.concatenate([getattr(one, name) for one in seen.regions]) for name in Regions._fields},
        "lesson_start": np.concatenate([[0], np.cumsum(learned)]).astype(np.int64),
        "lesson_frames": np.array([f for one in seen.learning_rounds for f in one.frames], dtype=np.int64),
        "taught": _text(tuple(one.model_digest for one in seen.learning_rounds)),
        "sample_frames": np.array(frames, dtype=np.int64),
        "samples": np.stack([seen.samples[frame] for frame in frames]),
    }


def _detections(arrays: Arrays, tracks: RegionTracks) -> Detections:
    everything = Regions(*(arrays[name] for name in Regions._fields))
    regions = tuple(everything.part(a, b) for a, b in itertools.pairwise(arrays["start"].tolist()))
    frames, starts = arrays["lesson_frames"].tolist(), arrays["lesson_start"].tolist()
    learning_rounds = tuple(
        LearningRound(tuple(frames[a:b]), taught)
        for (a, b), taught in zip(itertools.pairwise(starts), arrays["taught"].tolist(), strict=True)
    )
    samples = dict(zip(arrays["sample_frames"].tolist(), arrays["samples"], strict=True))
    return Detections(regions, tracks.time_s, tracks.size, learning_rounds, samples)
