"""Masks of the markers' colors in the current frame, cached in memory for the overlay.

No file keeps them. Their key is the footage and the colors they were made for: undo brings the matching
preview back, and a preview of other colors is never shown.
"""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from bpy.types import Context, PropertyGroup, Scene

from ...core.arrays import Array, Image, SingleArray
from ...core.markers.ignored_regions import IgnoredPixels, IgnoredRegion
from ...core.markers.region_tracks import MarkerStyle
from ..shell.takes import find_take, footage_of, redraw_footage
from .properties import ignored_regions

if TYPE_CHECKING:
    from ...core.markers.marker_check import MarkerCheck
    from ...core.video.clip import FrameReader


@dataclass(frozen=True, eq=False)
class ColorMask:
    """Mask of one color in a frame."""

    label: str  # Name of the marker, or names of all markers of this color
    color: tuple[float, float, float]  # The marker's color in sRGB, 0 to 1
    coverage: SingleArray
    """(rows, columns) share of each pixel that has the color, 0 to 1, at the resolution of segmentation."""
    outlines: list[Array]  # Closed outlines (N, 2) in footage pixels, the longest first


@dataclass(eq=False)
class Preview:
    """The learned colors of a take's markers, and the masks of the last frame."""

    check: "MarkerCheck"
    labels: tuple[str, ...]
    colors: tuple[tuple[float, float, float], ...]
    reader: "FrameReader | None" = None
    time_s: float | None = None  # Time of the masks' frame, from the clip's first [s]
    masks: tuple[ColorMask, ...] = field(default=())


_previews: dict[object, Preview] = {}
PICKED: dict[str, Preview] = {}
"""Preview of colors that are being picked and are not the take's yet, by the take's identifier."""


def keep_preview(take: PropertyGroup, styles: tuple[MarkerStyle, ...], check: "MarkerCheck") -> None:
    """Cache the learned colors of a take's markers."""
    _previews.pop(key := _key(take), None)
    _previews[key] = learned_preview(styles, check)
    while len(_previews) > 4:
        del _previews[next(iter(_previews))]


def preview_of(take: PropertyGroup) -> Preview | None:
    """The preview of a take's markers as they are now; None if they were not checked."""
    if take.clip is None:
        return None
    return PICKED.get(take.identifier) or _previews.get(_key(take))


def clear_previews() -> None:
    """Drop all previews, and close their files."""
    _previews.clear()
    PICKED.clear()


def update_masks(scene: Scene) -> Preview | None:
    """Make the masks of the current frame, unless they are made already; return their preview."""
    from ...core.markers.regions import color_masks, mask_outlines
    from ...core.video.clip import FrameReader

    take = find_take(scene)
    preview = preview_of(take) if take is not None else None
    if preview is None or is_of_frame(preview, scene):
        return preview
    footage, preview.masks = footage_of(scene, take), ()
    preview.reader = preview.reader or FrameReader(footage.open())
    image = preview.reader.image_at(footage.shown_s)
    if image is not None:
        coverages = color_masks(image, preview.check.model, ignored_mask(take))
        preview.masks = tuple(
            ColorMask(label, color, coverage, mask_outlines(coverage, image.shape[1] // coverage.shape[1]))
            for label, color, coverage in zip(preview.labels, preview.colors, coverages, strict=True)
        )
    preview.time_s = footage.shown_s
    return preview


def show_masks(context: Context, shown: bool) -> bool:
    """Switch the masks on or off; return whether they were shown."""
    before = bool(context.window_manager.keymark_show_masks)
    context.window_manager.keymark_show_masks = shown
    redraw_footage(context)
    return before


def is_of_frame(preview: Preview, scene: Scene) -> bool:
    """Whether a preview of the active take's markers is of the current frame, by the time in the clip."""
    take = find_take(scene)
    return take is not None and preview.time_s == footage_of(scene, take).shown_s


def ignored_mask(take: PropertyGroup, more: tuple[IgnoredRegion, ...] = ()) -> Image | None:
    """The mask (rows, columns) of what is ignored in the current frame, and of more; None if nothing is."""
    scene = take.id_data
    pixels = IgnoredPixels((*ignored_regions(take), *more), (take.clip.size[0], take.clip.size[1]))
    return pixels.mask(scene.frame_current - footage_of(scene, take).first_frame)


def learned_preview(styles: tuple[MarkerStyle, ...], check: "MarkerCheck") -> Preview:
    """A preview without masks yet."""
    groups = check.groups
    labels = tuple(" / ".join(styles[marker].name for marker in group) for group in groups)
    colors = [tuple(value / 255.0 for value in styles[group[0]].color_srgb) for group in groups]
    return Preview(check, labels, tuple((red, green, blue) for red, green, blue in colors))


def _key(take: PropertyGroup) -> tuple[object, ...]:
    """The footage's digest, names and colors of markers that have one, and what is ignored."""
    picked = tuple((marker.name, tuple(marker.color)) for marker in take.markers if marker.is_picked)
    return take.clip_state.contents, picked, ignored_regions(take)
