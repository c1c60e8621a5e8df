"""What a scene's take is held against: markers, keypoint files, motion tracks, clicked points, contours."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.arrays import Array
from ...core.footage.keypoints.people import People
from .clicked_keypoints import ClickedPoint, people_of_clicks
from .footage import Footage
from .keypoint_files import read_keypoint_file
from .track_keypoints import AssignedTrack, people_of_tracks

if TYPE_CHECKING:
    from ...core.footage.ignored_regions import IgnoredRegion
    from ...core.footage.marker_style import MarkerStyle


@dataclass(frozen=True)
class SceneEvidence:
    """Evidence beside the keyframes, as far as it is switched on."""

    markers: "tuple[MarkerStyle, ...]" = ()
    files: tuple[Path, ...] = ()
    """Files of keypoints, or folders of them."""
    tracks: tuple[AssignedTrack, ...] = ()
    clicks: tuple[ClickedPoint, ...] = ()
    depth_hints: bool = True
    """Whether a detector's guess of depths is used."""
    contours: bool = True
    ignored_regions: "tuple[IgnoredRegion, ...]" = ()
    """Regions of the picture that are never a marker."""

    @property
    def has_keypoints(self) -> bool:
        """Whether there is any source of keypoints."""
        return bool(self.files or self.tracks or self.clicks)

    def people(self, footage: Footage, frames: Array) -> tuple[People, ...]:
        """Everyone whom each source of keypoints saw, clicked points first.

        Args:
            footage: The clip in its scene.
            frames: (F,) scene frame of each frame of the clip.

        Raises:
            InputError: A file is missing, or cannot be one of this clip.
        """
        width, height = footage.clip.size
        files = tuple(
            read_keypoint_file(path, len(frames), (width, height), footage.rate, footage.first_frame)
            for path in self.files
        )
        if not self.depth_hints:
            files = tuple(people.without_hints() for people in files)
        clicks = people_of_clicks(footage, frames, self.clicks)
        return (*clicks, *people_of_tracks(footage, frames, self.tracks), *files)
