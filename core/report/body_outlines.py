"""Outlines of the performer's limbs and trunk over the footage, where no marker shows how the motion fits."""

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..body.kinematics import Pose
from ..estimate.reconstruct import Reconstruction
from ..observation.contours import SHARES, SIDES, ContourModel
from .canvas import WHITE, Canvas, Color

OUTLINE: Color = (150, 70, 150)


def performer_contours(reconstruction: Reconstruction) -> ContourModel:
    """The contours of a reconstruction's performer: those learned from the footage, or of an average body."""
    solution = reconstruction.solution
    if solution is not None and solution.contours is not None:
        return solution.contours.model
    return ContourModel.average(reconstruction.motion.body, reconstruction.model.camera)


def draw_outlines(
    canvas: Canvas, model: ContourModel, pose: Pose, frame: int, to_canvas: Callable[[Array], Array]
) -> None:
    """Draw the contour lines that the motion predicts in one frame, those of nearer parts over others.

    Args:
        canvas: The canvas.
        model: The contours of the performer's parts.
        pose: Forward kinematics of the clip's postures.
        frame: Frame index in the clip.
        to_canvas: From pixels of the clip (N, 2) to points of the canvas.
    """
    index = slice(frame, frame + 1)
    predicted = model.evaluate(pose[index], np.array([frame]))
    pixels = to_canvas(predicted.pixel[0]).reshape(-1, len(SHARES), len(SIDES), 2)
    depth = predicted.depth[0].reshape(len(pixels), -1).mean(axis=1)
    for part in np.argsort(-depth):
        for side in range(len(SIDES)):
            line = pixels[part, :, side]
            canvas.line(line, WHITE, 2.4)
            canvas.line(line, OUTLINE, 1.2)
