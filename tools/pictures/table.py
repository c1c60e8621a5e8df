"""Which picture of the docs comes from where; docs/pictures has these and no others.

The photographs of the guide to filming were rendered once in the studio of tools/studio; they show nothing
of the program and are not drawn anew.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

MOVING = "keymark.webp"
POINTS = (
    *("distance", "height", "direction", "still", "light", "shutter"),
    *("clothes", "colors", "whole", "alone", "room", "start"),
)
KEPT = tuple(f"filming_{point}.jpg" for point in POINTS)
"""Photographs of the guide to filming, which stay as they are."""
DRAWN = (
    MOVING,
    "character.jpg",
    "comparison.jpg",
    "libraries.jpg",
    "listing_featured.jpg",
    "listing_icon.png",
)
"""Pictures that draw_pictures.py makes itself."""

Box = tuple[int, int, int, int]
VIEWPORT: Box = (0, 27, 1315, 980)
"""Left, top, right and bottom, on a session's screen, of the viewport with sidebar and timeline [px]."""
LARGE: Box = (400, 27, 1580, 1054)
"""The right part of the viewport on a screen of 1920x1080, with the sidebar."""
SMALL: Box = (0, 27, 1052, 700)
"""The viewport on one of 1280x720."""
SHOWN_WIDTH = 1053
"""Width to which a part of the screen is reduced, where it is wider [px]."""


@dataclass(frozen=True)
class Screenshot:
    """A part of a picture that `make test-ui` takes of the screen."""

    session: str
    """Its folder in build/screenshots."""
    name: str
    """Its name without the number, which changes where a session gets another step."""
    box: Box = VIEWPORT

    def file(self, screenshots: Path) -> Path:
        """The picture of the screen.

        Raises:
            SystemExit: It is missing.
        """
        found = sorted((screenshots / self.session).glob(f"[0-9][0-9]_{self.name}.png"))
        if not found:
            folder = screenshots / self.session
            raise SystemExit(f"{folder}: the screenshot `{self.name}` is missing; `make test-ui` takes it")
        return found[-1]


STATES = ("clip", "performer", "poses", "candidate", "correcting", "motion", "character", "export")
"""Of the panel, from the clip to the character; each is shown on a large screen and on a small one."""
SCREENSHOTS: Mapping[str, Screenshot] = {
    **{f"workflow_{state}.jpg": Screenshot("states_1080", state, LARGE) for state in STATES},
    **{f"small_{state}.jpg": Screenshot("states_720", state, SMALL) for state in STATES},
    "first_example.jpg": Screenshot("first", "example"),
    "first_reconstructed.jpg": Screenshot("first", "reconstructed"),
    "first_review.jpg": Screenshot("first", "review"),
    "first_character.jpg": Screenshot("first", "character"),
    "first_retargeted.jpg": Screenshot("first", "retargeted"),
    "workflow_camera.jpg": Screenshot("library", "lines"),
    "workflow_follow.jpg": Screenshot("plain", "clicked"),
    "workflow_markers.jpg": Screenshot("library", "markers"),
    "workflow_side.jpg": Screenshot("library", "from_the_side"),
    "workflow_keyframes.jpg": Screenshot("demo", "keyframes"),
    "workflow_reconstructing.jpg": Screenshot("demo", "reconstructing"),
    "libraries_match.jpg": Screenshot("library", "posed_all"),
}
"""Pictures that show Blender."""
MADE = (*DRAWN, *SCREENSHOTS)
ALL = (*MADE, *KEPT)
