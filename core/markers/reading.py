"""A reading: the result of one pass over a clip, for all later steps."""

import itertools
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InputError
from ..files.digest import digest, file_fingerprint
from ..video.album import Album, Glimpses, Watch, WatchedClip
from ..video.clip import Clip
from ..video.frame_checks import NO_FINDINGS, FrameChecks, FrameFindings
from ..video.image_sequence import find_images
from .color_learning import ColorLearner
from .ignored_regions import IgnoredPixels, IgnoredRegion
from .markers import assign_detections, detect_markers
from .region_tracks import Detections, ExpectedRegions, LearningRound, MarkerStyle, Regions, RegionTracks


@dataclass(frozen=True, eq=False)
class Reading:
    """Result of one pass over a clip."""

    tracks: RegionTracks  # the markers' regions in every frame
    album: Album | None = None  # a small picture of every frame; None where only markers are used
    detections: Detections | None = None  # all regions of the markers' colors; None where they were not kept
    notes: tuple[str, ...] = ()  # sentences on possible faults of the clip
    key: str = ""  # cache key of the clip and the settings, see `reading_key`; empty where unknown
    frame_findings: FrameFindings = NO_FINDINGS  # blank and repeated frames, cuts and interlacing
    glimpses: Glimpses | None = None  # a few larger pictures; None where it was not read from a clip
    shot: tuple[int, int] | None = None
    """First frame of the only shot that it shows and the one after its last, see `shot_of`; None for all."""
    steady: Array | None = None  # (F, 3, 3) from what it shows to the clip's pixels, see `steady_camera`


Arrays = dict[str, NDArray[Any]]

NOTICED = ("blank", "cuts", "changes", "repeated")
TRACKED = ("centroid", "second_moment", "area", "quality", "clipped", "time_s")


def reading_arrays(reading: Reading) -> Arrays:
    """A reading as arrays by name."""
    tracks, findings = reading.tracks, reading.frame_findings
    arrays: Arrays = {f"tracks.{name}": getattr(tracks, name) for name in TRACKED}
    arrays |= {
        "key": np.array(reading.key),
        "notes": _text(reading.notes),
        **{f"noticed.{name}": np.array(getattr(findings, name), dtype=np.int64) for name in NOTICED},
        "noticed.rest": np.array([findings.frames, findings.interlaced], dtype=np.int64),
        "tracks.names": _text(tracks.names),
        "tracks.notes": _text(tracks.notes),
        "tracks.size": np.array(tracks.size),
    }
    album, seen, glimpses = reading.album, reading.detections, reading.glimpses
    parts = {
        "album": {} if album is None else album.to_arrays(),
        "glimpses": {} if glimpses is None else glimpses.to_arrays(),
        "seen": {},
    }
    if seen is not None:  # concatenated regions with the index of each frame's first one; rounds likewise
        counts, rounds = [len(found.color) for found in seen.regions], seen.learning_rounds
        frames, first = sorted(seen.samples), [len(one.frames) for one in rounds]
        parts["seen"] = {
            "start": np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            **{name: np.concatenate([getattr(at, name) for at in seen.regions]) for name in Regions._fields},
            "lesson_start": np.concatenate([[0], np.cumsum(first)]).astype(np.int64),
            "lesson_frames": np.array([frame for one in rounds for frame in one.frames], dtype=np.int64),
            "taught": _text(tuple(one.model_digest for one in rounds)),
            "sample_frames": np.array(frames, dtype=np.int64),
            "samples": np.stack([seen.samples[frame] for frame in frames]),
        }
    return arrays | {f"{part}.{name}": array for part, own in parts.items() for name, array in own.items()}


def reading_from_arrays(arrays: Mapping[str, NDArray[Any]]) -> Reading:
    """The reading that `reading_arrays` gave; KeyError or ValueError where they are not of one."""
    width, height = arrays["tracks.size"].tolist()
    tracks = RegionTracks(
        names=tuple(arrays["tracks.names"].tolist()),
        size=(width, height),
        notes=tuple(arrays["tracks.notes"].tolist()),
        **{name: arrays[f"tracks.{name}"] for name in TRACKED},
    )
    album = Album.from_arrays(_under("album", arrays)) if "album.picture" in arrays else None
    seen, own = None, _under("seen", arrays)
    if own:
        everything = Regions(*(own[name] for name in Regions._fields))
        learned, taught = own["lesson_frames"].tolist(), own["taught"].tolist()
        lessons = zip(itertools.pairwise(own["lesson_start"].tolist()), taught, strict=True)
        seen = Detections(
            tuple(everything.part(first, end) for first, end in itertools.pairwise(own["start"].tolist())),
            tracks.time_s,
            tracks.size,
            tuple(LearningRound(tuple(learned[first:end]), model) for (first, end), model in lessons),
            dict(zip(own["sample_frames"].tolist(), own["samples"], strict=True)),
        )
    frames, interlaced = arrays["noticed.rest"].tolist()
    noticed = {name: tuple(arrays[f"noticed.{name}"].tolist()) for name in NOTICED}
    findings = FrameFindings(frames=frames, interlaced=bool(interlaced), **noticed)
    glimpses = Glimpses.from_arrays(_under("glimpses", arrays)) if "glimpses.picture" in arrays else None
    notes = tuple(arrays["notes"].tolist())
    return Reading(tracks, album, seen, notes, str(arrays["key"]), findings, glimpses)


def _under(name: str, arrays: Mapping[str, NDArray[Any]]) -> Arrays:
    start = f"{name}."
    return {key.removeprefix(start): array for key, array in arrays.items() if key.startswith(start)}


def _text(lines: tuple[str, ...]) -> NDArray[Any]:
    return np.array(lines, dtype=np.str_) if lines else np.zeros(0, dtype="<U1")


FORMAT = 4  # version of the reading's algorithm and arrays; raised whenever either changes


def reading_key(
    path: Path,
    fps: float,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None,
    ignored: Sequence[IgnoredRegion] = (),
) -> str:
    """Cache key that changes with everything a reading depends on, of a clip as `Clip.open` takes it."""
    wanted = tuple((style.name, style.segment, tuple(style.color_srgb)) for style in styles)
    regions = None if expected is None else (expected.center, expected.radius)
    left_out = [(one.box, one.stroke, one.radius_px, one.frames) for one in ignored] if wanted else []
    return f"reading-{digest(FORMAT, _footage(path, fps), wanted, *left_out)}-{digest(regions)}"


def of_same_footage(key: str, other: str) -> bool:
    """Whether two keys differ at most in the markers' expected regions."""
    return bool(key) and key.rpartition("-")[0] == other.rpartition("-")[0]


def footage_digest(path: Path) -> str:
    """Digest of a clip's file, or of the images of a sequence, independent of their folder."""
    return digest(*_footage(path, 0.0))


def _footage(path: Path, fps: float) -> tuple[object, ...]:
    try:
        images = find_images(path)
        if images is None:
            return (file_fingerprint(path),)
        states = [(file.name, file.stat()) for file in images]
        names = tuple((name, state.st_size, state.st_mtime_ns) for name, state in states)
        some = images[:: max(1, len(images) // 24)]
        return fps, names, tuple(file_fingerprint(file) for file in some)
    except OSError as error:
        raise InputError(f"{path}: the clip cannot be read ({error.strerror})") from error


def read_clip(
    clip: Clip,
    styles: Sequence[MarkerStyle],
    expected: ExpectedRegions | None = None,
    with_album: bool = True,
    kept: Reading | None = None,
    ignored: Sequence[IgnoredRegion] = (),
    watch: Watch | None = None,
) -> Generator[float, None, Reading]:
    """Track the markers through a clip, check its frames and keep a small picture of each.

    A cached reading of any clip may be `kept`: it is returned without decoding the clip if its key is the
    same; if only the expected regions differ and the colors would be learned alike, its detections are
    assigned to the markers anew. The result is the same to the last digit. Whoever is to `watch` sees each
    frame if the clip is decoded. Yields the fraction done.
    """
    yield 0.0
    key = reading_key(clip.path, clip.fps, styles, expected, ignored)
    if kept is not None and kept.tracks.size != clip.size:  # of oblong pixels, as they are stored
        kept = None
    if kept is not None and (kept.album is not None or not with_album):
        kept = kept if with_album else replace(kept, album=None)
        if kept.key == key:
            return kept
        seen, pixels = kept.detections, IgnoredPixels(tuple(ignored), clip.size)
        colors = ColorLearner(clip.path, clip.size, styles, expected, pixels)
        if seen is not None and of_same_footage(kept.key, key) and colors.learn_again(seen):
            tracks = without_tracks(assign_detections(seen, styles, expected), kept.frame_findings.repeated)
            return replace(kept, tracks=tracks, key=key)
    album, checks, glimpses = Album() if with_album else None, FrameChecks(), Glimpses.of(clip)
    watched = WatchedClip(clip.path, clip.source, checks=checks, album=album, glimpses=glimpses, watch=watch)
    seen = None
    try:
        if styles:
            seen = yield from detect_markers(watched, styles, expected, ignored)
            yield 1.0
        else:
            time_s: list[float] = []
            for _, stamp, _ in watched.frames():
                time_s.append(stamp)
                yield min(len(time_s) / clip.frame_count, 1.0)
    except InputError as error:
        why = checks.nothing_seen() if styles else None
        if why is not None:
            raise InputError(f"{clip.path}: {why}") from error
        if styles and clip.notes:
            raise InputError("; ".join([str(error), *clip.notes])) from error
        raise
    findings = checks.findings()
    if album is not None:
        album = album.excluding(findings.repeated)
    if seen is None:
        tracks = RegionTracks.unmarked(np.array(time_s), clip.size)
    else:  # repeated pictures show no other moment
        tracks = without_tracks(assign_detections(seen, styles, expected), findings.repeated)
    return Reading(tracks, album, seen, key=key, frame_findings=findings, glimpses=glimpses)


def without_tracks(tracks: RegionTracks, frames: Sequence[int]) -> RegionTracks:
    """The tracks with nothing seen in some frames."""
    if not frames:
        return tracks
    nothing = {"centroid": np.nan, "second_moment": np.nan, "area": np.nan, "quality": 0.0, "clipped": False}
    arrays: dict[str, Any] = {name: np.array(getattr(tracks, name)) for name in nothing}
    for name, value in nothing.items():
        arrays[name][list(frames)] = value
    return replace(tracks, **arrays)


_known: dict[tuple[str, float], Array] = {}


def clip_times(
    clip: Clip,
    kept: Reading | None = None,
    styles: Sequence[MarkerStyle] = (),
    ignored: Sequence[IgnoredRegion] = (),
) -> Generator[float, None, Array]:
    """The times (F,) [s] of all frames, by a pass over the clip unless its file is known and unchanged.

    A cached reading knows them where it is one of this clip with these markers and ignored regions. Yields
    the fraction done.
    """
    key = footage_digest(clip.path), clip.fps
    if key not in _known:
        own = "" if kept is None else reading_key(clip.path, clip.fps, styles, None, ignored)
        if kept is not None and of_same_footage(kept.key, own):
            time_s = kept.tracks.time_s.copy()
        else:
            stamps: list[float] = []
            for stamp in clip.source.time_stamps():
                stamps.append(stamp)
                yield min(len(stamps) / clip.frame_count, 1.0)
            time_s = np.array(stamps, dtype=np.float64)
        time_s.setflags(write=False)
        _known[key] = time_s
        for oldest in list(_known)[:-8]:
            del _known[oldest]
    return _known[key]
