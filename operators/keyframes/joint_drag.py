"""One drag of a joint in a 3D view: from movements of the mouse to the posture that follows."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.arrays import Array
from ..shell.view_under_mouse import WorldInRegion

if TYPE_CHECKING:
    from ...core.body.kinematics import Body
    from ...core.body.posture import Posture
    from ..bridge.scene_frames import Pose

PRECISE = 0.1
"""Share of the mouse's way that counts with Shift held, as in Blender's own transforms."""


@dataclass
class JointDrag:
    """A joint that is being dragged."""

    joint: str
    view: WorldInRegion
    start: Array
    """(3,) where the joint was [m]."""
    position: Array
    """(2,) where the view showed it [px]."""
    body: "Body"
    posture: "Posture"
    """The posture at the beginning."""
    pose: "Pose"
    """The channels of the actor's bones at the beginning, to restore them."""
    mouse: tuple[int, int]
    """Where the mouse was last, in the window [px]."""
    moved: Array = field(default_factory=lambda: np.zeros(2))
    """How far it has been dragged across the view [px]."""
    depth_m: float = 0.0
    """How far it has been pushed away from the viewer [m]."""

    def follow(self, event: bpy.types.Event) -> None:
        """Take a movement of the mouse: across the view, or in depth with Ctrl held, where up is away."""
        step = np.array([event.mouse_x - self.mouse[0], event.mouse_y - self.mouse[1]], dtype=np.float64)
        self.mouse = event.mouse_x, event.mouse_y
        step *= PRECISE if event.shift else 1.0
        if event.ctrl:
            aside = self.view.place(self.position + [1.0, 0.0], self.start)
            self.depth_m += float(step[1]) * float(np.linalg.norm(aside - self.start))
        else:
            self.moved = self.moved + step

    @property
    def has_moved(self) -> bool:
        """Whether the joint was dragged anywhere."""
        return bool(self.moved.any()) or self.depth_m != 0.0

    @property
    def pushed(self) -> bool:
        """Whether it was dragged in depth."""
        return self.depth_m != 0.0

    @property
    def sight(self) -> Array:
        """(3,) direction in which the view looks at the place."""
        return self.view.sight(self.position + self.moved)

    @property
    def place(self) -> Array:
        """(3,) where the joint is dragged to [m]."""
        across = self.view.place(self.position + self.moved, self.start)
        return np.asarray(across + self.depth_m * self.sight)
