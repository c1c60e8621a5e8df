"""A reading as arrays of numbers and text, and back: the form in which it is kept in a file."""

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clips.album import Album
from .clips.frame_checks import Noticed
from .detections import Lesson, Sightings
from .reading import Reading
from .region_tracks import RegionTracks
from .segmentation.regions import Regions

Arrays = dict[str, NDArray[Any]]

TRACKED = ("centroid", "second_moment", "area", "quality", "clipped", "time_s")


def reading_arrays(reading: Reading) -> Arrays:
    """Return everything a reading holds, by name."""
    tracks = reading.tracks
    arrays: Arrays = {f"tracks.{name}": getattr(tracks, name) for name in TRACKED}
    arrays |= {
        "key": np.array(reading.key),
        "notes": _text(reading.notes),
        "noticed.blank": np.array(reading.noticed.blank, dtype=np.int64),
        "noticed.cuts": np.array(reading.noticed.cuts, dtype=np.int64),
        "noticed.rest": np.array([reading.noticed.frames, reading.noticed.interlaced], dtype=np.int64),
        "tracks.names": _text(tracks.names),
        "tracks.notes": _text(tracks.notes),
        "tracks.size": np.array(tracks.size),
    }
    if reading.album is not None:
        arrays |= {f"album.{name}": array for name, array in reading.album.to_arrays().items()}
    if reading.sightings is not None:
        arrays |= {f"seen.{name}": array for name, array in _sightings_arrays(reading.sightings).items()}
    return arrays


def reading_from_arrays(arrays: Mapping[str, NDArray[Any]]) -> Reading:
    """Return the reading that was kept as arrays.

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
    seen = _sightings(_under("seen", arrays), tracks) if "seen.start" in arrays else None
    frames, interlaced = arrays["noticed.rest"].tolist()
    blank, cuts = (tuple(arrays[f"noticed.{name}"].tolist()) for name in ("blank", "cuts"))
    noticed = Noticed(frames, blank, cuts, bool(interlaced))
    return Reading(tracks, album, seen, tuple(arrays["notes"].tolist()), str(arrays["key"]), noticed)


def _under(name: str, arrays: Mapping[str, NDArray[Any]]) -> Arrays:
    return {
        key.removeprefix(f"{name}."): array for key, array in arrays.items() if key.startswith(f"{name}.")
    }


def _text(lines: tuple[str, ...]) -> NDArray[Any]:
    return np.array(lines, dtype=np.str_) if lines else np.zeros(0, dtype="<U1")


def _sightings_arrays(seen: Sightings) -> Arrays:
    """Regions one after the other with where each frame's begin, lessons likewise."""
    counts = [len(found.color) for found in seen.regions]
    learned = [len(lesson.frames) for lesson in seen.lessons]
    frames = sorted(seen.samples)
    return {
        "start": np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        **{name: np.concatenate([getattr(one, name) for one in seen.regions]) for name in Regions._fields},
        "lesson_start": np.concatenate([[0], np.cumsum(learned)]).astype(np.int64),
        "lesson_frames": np.array([f for lesson in seen.lessons for f in lesson.frames], dtype=np.int64),
        "taught": _text(tuple(lesson.taught for lesson in seen.lessons)),
        "sample_frames": np.array(frames, dtype=np.int64),
        "samples": np.stack([seen.samples[frame] for frame in frames]),
    }


def _sightings(arrays: Arrays, tracks: RegionTracks) -> Sightings:
    everything = Regions(*(arrays[name] for name in Regions._fields))
    regions = tuple(everything.part(a, b) for a, b in itertools.pairwise(arrays["start"].tolist()))
    frames, starts = arrays["lesson_frames"].tolist(), arrays["lesson_start"].tolist()
    lessons = tuple(
        Lesson(tuple(frames[a:b]), taught)
        for (a, b), taught in zip(itertools.pairwise(starts), arrays["taught"].tolist(), strict=True)
    )
    samples = dict(zip(arrays["sample_frames"].tolist(), arrays["samples"], strict=True))
    return Sightings(regions, tracks.time_s, tracks.size, lessons, samples)
