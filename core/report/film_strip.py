"""A strip of small pictures of the footage with the estimate over it, by which a list shows a take.

Each picture is a square around the performer, so that a small figure in a wide shot is still seen.
"""

from collections.abc import Mapping

from ..arrays import Array, Image
from ..take.motion import Motion
from ..take.take import Take
from .canvas import Canvas
from .overlay_sheet import paler
from .square_crop import PAPER, square_of, squares_around
from .stick_figure import draw_figure, stick_figure
from .strip_layout import GAP, SIDE, SIZE

LIMB_WIDTH = 2.2


def film_strip(take: Take, motion: Motion, images: Mapping[int, Image]) -> Image:
    """Draw frames of the clip side by side, each cut to a square around the performer.

    Args:
        take: The take.
        motion: Its motion.
        images: At most `PICTURES` frames of the clip by frame index, in the order to show them; reduced or
            whole.

    Returns:
        (SIZE[1], SIZE[0], 3) picture.
    """
    strip = Canvas(*SIZE, PAPER)
    figure = stick_figure(motion)
    centers, side = squares_around(motion.points, take.camera, list(images))
    for index, ((frame, image), center) in enumerate(zip(images.items(), centers, strict=True)):
        corner, scale = center - 0.5 * side, SIDE / side
        tile = Canvas(SIDE, SIDE)
        tile.paste(square_of(paler(image), corner, side, take.camera.resolution), 0, 0, SIDE, SIDE)

        def project(
            points: Array, frame: int = frame, corner: Array = corner, scale: float = scale
        ) -> tuple[Array, Array]:
            pixels, depth = take.camera.project(points, frame)
            return scale * (pixels - corner), depth

        draw_figure(tile, figure, frame, project, LIMB_WIDTH, outlined=True)
        strip.paste(tile.image(), index * (SIDE + GAP), 0, SIDE, SIDE)
    return strip.image()
