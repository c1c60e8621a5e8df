"""The result of a reconstruction, and how it is written into the scene."""

from dataclasses import dataclass

import bpy

from ...core.arrays import Array
from ...core.estimate.reconstruct import Reconstruction
from ...core.review.review import Review
from ..bridge.fcurves import write_motion
from ..review.review_results import show_review
from ..shell.outdated import reconstructed_again
from ..shell.results import keep_reading, keep_reconstruction, keep_review
from ..shell.takes import actor_of, take_by_identifier


@dataclass(frozen=True, eq=False)
class ReconstructionResult:
    """The result of a reconstruction, for the scene."""

    take: str
    """The take's identifier."""
    frames: Array
    """(F,) scene frames."""
    reconstruction: Reconstruction
    review: Review
    notes: tuple[str, ...]

    def write(self, scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
        """Write the motion's Action and its review, and let the Action animate the actor; returns the take.

        Raises:
            InputError: The take or its actor has been removed, or the actor lacks bones.
        """
        take = take_by_identifier(scene, self.take)
        take.motion_action = write_motion(
            actor_of(take),
            self.reconstruction.motion,
            take.motion_action,
            take.keyframe_action,
            self.frames,
        )
        take.motion_action.use_fake_user = True
        reconstructed_again(take)
        keep_reading(take, self.reconstruction.reading)
        keep_reconstruction(take, self.reconstruction)
        keep_review(take, self.review)
        show_review(take, self.review)
        return take
