"""Find the camera from lines drawn over the footage, and from the performer upright at several places."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from bpy.types import Context, Event, OperatorProperties, PropertyGroup

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ...core.camera.camera_evidence import Uprights
from ...core.errors import InputError, KeymarkError
from ..bridge.footage import still_camera as still_camera_of
from ..footage import found_camera
from ..footage.found_camera import HEIGHT, NEAR_PX, DrawnLine, Pixel
from ..footage.load_footage import lens_is_guess
from ..footage.properties import KINDS, still_camera
from ..shell import footage_view, need
from ..shell.base_operator import BaseOperator, warn
from ..shell.fields import SKIP_SAVE, Choice
from ..shell.footage_view import ClickSequence, FootageRequest, FootageView, ui_scale
from ..shell.results import reading_of
from ..shell.take_state import TakeState
from ..shell.takes import active_take, footage_of, redraw_sidebars_soon
from .evidence import scene_evidence

if TYPE_CHECKING:
    from ...core.camera.camera_fit import CameraFit


def standing_performer(take: PropertyGroup, stature_m: float) -> Uprights:
    """Moments in which somebody of that stature is upright; none without keypoints of this clip."""
    from ...core.detect.standing_moments import standing_keypoints
    from ..bridge.take_from_scene import frame_in_footage

    if not TakeState(take).has_keypoints:
        return Uprights.none()
    body = Body(Actor.from_stature(stature_m))
    with suppress(InputError):
        source = footage_of(take.id_data, take)
        seen = frame_in_footage(source, scene_evidence(take), reading_of(take))
        found = standing_keypoints(seen.keypoints(body), body, source.rate)
        if len(found) >= 2:  # fewer tell nothing
            return found
    return Uprights.none()


REQUESTS = {
    "VERTICAL": ("Draw plumb lines", "along a door frame, the corner of a wall"),
    "LEVEL": ("Draw level lines", "on the floor or a wall, parallel to each other"),
    "ACROSS": ("Draw a level line across", "at right angles to the other level ones"),
    "HEIGHT": ("Draw a height", "from between the feet to the top of the head, or type another known one"),
}
FEET_AND_HEAD = "on the floor between the feet, then on the top of the head"
PERFORMER_REQUEST = ("Click on the performer", f"{FEET_AND_HEAD}; type the body height")
WALK_REQUEST = ("Keypoints show the camera", f"Enter takes it; or click {FEET_AND_HEAD}")
KEYS = "Tab: Other Lines   |   X: Remove   |   Enter: Take   |   Esc: Cancel"


class KEYMARK_OT_camera_from_lines(ClickSequence, BaseOperator, bpy.types.Operator):
    """Find the camera from lines that you draw over the picture; the floor's grid shows the result"""

    bl_label = "Camera from Lines"
    requirements = (need.footage, need.camera, still_camera, need.idle)

    kind: Choice("Begin with", "The lines that are drawn first", items=KINDS, options=SKIP_SAVE)

    _drawing: Any = None
    _upright: Any = None  # Body height, and moments in which keypoints show somebody of that height upright
    _mouse: Any = None  # (2,) [window px]

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        if properties.kind == HEIGHT:
            return (
                "Find the camera from the performer: click on the floor between the feet, then on the "
                "top of the head, where the performer stands upright; in other frames too, nearer and "
                "farther away; keypoints of somebody who stands or walks do so as well"
            )
        return "Find the camera from lines that you draw over the picture; the floor's grid shows the result"

    def prepare(self, context: Context, take: PropertyGroup) -> None:
        of_performer = self.kind == HEIGHT
        self._drawing = found_camera.Drawing(
            self.kind,
            of_performer,
            found_camera.read_lines(take),
            stature_m=take.stature,
            of_performer=of_performer,
        )
        found_camera.show(self._drawing)

    def modal(self, context: Context, event: Event) -> set[str]:
        drawing, pressed = self._drawing, event.value == "PRESS"
        self._mouse = np.array([event.mouse_x, event.mouse_y], dtype=np.float64)
        if event.type in ("MOUSEMOVE", "LEFTMOUSE"):
            footage_view.follow_mouse(context, event)
            return self._point(context, event)
        if pressed and event.type in ("X", "DEL"):
            drawing.remove(self._distance_of_line(context))
        elif pressed and event.unicode and event.unicode in "0123456789.":
            drawing.type(event.unicode)
        else:
            return super().modal(context, event)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def go_on(self, context: Context) -> None:
        self._drawing.next_kind()

    def go_back(self, context: Context) -> None:
        if not self._drawing.type("\b"):
            self._drawing.remove(self._distance_of_line(context))

    def _point(self, context: Context, event: Event) -> set[str]:
        drawing, view = self._drawing, self._view(context)
        action = "MOVE" if event.type == "MOUSEMOVE" else event.value
        if view is None or (action == "MOVE" and drawing.held is None):
            return {"PASS_THROUGH"} if action == "MOVE" else {"RUNNING_MODAL"}
        x, y = view.to_footage(self._mouse - (view.region.x, view.region.y))
        pixel, near_px = (float(x), float(y)), NEAR_PX * ui_scale()

        def apart(one: Pixel, other: Pixel = pixel) -> float:
            """Distance in the region of two pixels, as a share of how near is near."""
            return float(np.linalg.norm(view.to_region(one) - view.to_region(other))) / near_px

        if action == "PRESS":
            drawing.press(pixel, context.scene.frame_current, apart)
        elif action in ("MOVE", "RELEASE"):
            drawing.move(pixel)
        if action == "RELEASE":
            drawing.release(lambda one, other: apart(one, other) * NEAR_PX / found_camera.CLICKED_PX)
        self.ask(context)
        return {"RUNNING_MODAL"}

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        """Find the camera by what is drawn so far, and say what to draw next."""
        drawing = self._drawing
        drawing.fit = None
        try:
            drawing.fit = self._fit(active_take(context.scene), drawing.complete, drawing.stature_m)
        except KeymarkError as error:
            warn(self, str(error))
        wanted = REQUESTS[drawing.kind]
        if drawing.of_performer and drawing.kind == HEIGHT:
            wanted = PERFORMER_REQUEST if drawing.lines or drawing.fit is None else WALK_REQUEST
        return FootageRequest(*wanted), KEYS

    def done(self, context: Context) -> set[str]:
        """Keep the lines and set the camera; if they say nothing of it, everything is as before."""
        take, lines = active_take(context.scene), self._drawing.complete
        before = found_camera.read_lines(take), take.stature
        stature, found = self._drawing.stature_m, lines or self._drawing.fit is not None
        self.cancel(context)
        if not found and not before[0]:
            return {"CANCELLED"}
        found_camera.store_lines(take, lines)
        take.stature = stature
        done = self.execute(context) if found else {"FINISHED"}
        if "CANCELLED" in done:
            found_camera.store_lines(take, before[0])
            take.stature = before[1]
        return done

    def cancel(self, context: Context) -> None:
        found_camera.show(None)
        super().cancel(context)
        redraw_sidebars_soon()

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        fit = self._fit(take, found_camera.read_lines(take), take.stature)
        if fit is None:
            raise InputError(f"take '{take.name}' has no lines to find its camera by; draw some")
        found_camera.write_fit(take, fit)
        self.report({"INFO"}, f"{found_camera.values(fit)}")

    def _fit(self, take: PropertyGroup, lines: list[DrawnLine], stature_m: float) -> "CameraFit | None":
        """The camera by lines, and by keypoints where the performer tells it; None without any."""
        from ...core.camera.camera_fit import fit_camera

        evidence = found_camera.evidence_of(lines, stature_m)
        if self.kind == HEIGHT:
            if self._upright is None or self._upright[0] != stature_m:
                self._upright = stature_m, standing_performer(take, stature_m)
            evidence = replace(evidence, uprights=evidence.uprights + self._upright[1])
        if not lines and not len(evidence.uprights):
            return None
        seen = still_camera_of(footage_of(take.id_data, take))
        return fit_camera(seen, evidence, lens_is_known=not lens_is_guess(take))

    def _view(self, context: Context) -> FootageView | None:
        x, y = self._mouse
        return footage_view.view_of_footage_under(context, active_take(context.scene), int(x), int(y))

    def _distance_of_line(self, context: Context) -> Callable[[DrawnLine], float]:
        """Tells the distance from the mouse to a line in the region, as a share of how near is near."""
        view = self._view(context)

        def distance(line: DrawnLine) -> float:
            if view is None:
                return np.inf
            mouse = self._mouse - (view.region.x, view.region.y)
            start, end = view.to_region(np.array(line.ends))
            along = end - start
            share = float((mouse - start) @ along / max(float(along @ along), 1e-9))
            nearest = start + min(max(share, 0.0), 1.0) * along
            return float(np.linalg.norm(mouse - nearest)) / (NEAR_PX * ui_scale())

        return distance
