"""Dragging the actor's joints in a 3D view: from movements of the mouse to the posture that follows."""

from dataclasses import dataclass, field
from math import ceil, floor
from typing import Any

import bpy
import numpy as np
from bpy.types import Context, Event, PropertyGroup

from ...core.arrays import Array
from ...core.body.human import HUMAN, limb_of
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ..bridge.actor_bones import evaluated, joint_places
from ..bridge.keyframes import read_keyframes
from ..bridge.pose import write_posture
from ..bridge.scene_frames import Pose, pose_of, restore_pose
from ..follow.properties import segment_title
from ..overlays.motion import window
from ..overlays.tools import Handles, show_keys
from ..shell import need
from ..shell.base_operator import BaseOperator, all_met, call, reported
from ..shell.fields import Choice, Switch, Vector
from ..shell.footage_view import NAVIGATION, WorldInRegion, ui_scale, view_under
from ..shell.job_progress import job_is_running
from ..shell.take_state import TakeState
from ..shell.takes import active_take, find_take, redraw_editors, redraw_sidebars_soon
from .corrections import DRAGGING, camera_now, put_right, set_corrected, shown_pose


@dataclass
class JointDrag:
    """A joint that is being dragged."""

    joint: str
    view: WorldInRegion
    start: Array  # (3,) where the joint was [m]
    position: Array  # (2,) where the view showed it [px]
    body: Body
    posture: Posture  # The posture at the beginning
    pose: Pose  # The channels of the actor's bones at the beginning, to restore them
    mouse: tuple[int, int]  # Where the mouse was last, in the window [px]
    moved: Array = field(default_factory=lambda: np.zeros(2))
    """How far it has been dragged across the view [px]."""
    depth_m: float = 0.0  # How far it has been pushed away from the viewer [m]
    shown: Posture | None = None  # The posture it has come to
    in_depth: bool = False  # whether it was put right in space, not in the picture alone

    def follow(self, event: Event) -> None:
        """Take a movement of the mouse: across the view, or in depth with Ctrl held, where up is away."""
        step = np.array([event.mouse_x - self.mouse[0], event.mouse_y - self.mouse[1]], dtype=np.float64)
        self.mouse = event.mouse_x, event.mouse_y
        step *= 0.1 if event.shift else 1.0  # as in Blender's own transforms
        if event.ctrl:
            aside = self.view.place(self.position + [1.0, 0.0], self.start)
            self.depth_m += float(step[1]) * float(np.linalg.norm(aside - self.start))
        else:
            self.moved = self.moved + step

    @property
    def sight(self) -> Array:
        """(3,) direction in which the view looks at the place."""
        return self.view.sight(self.position + self.moved)

    @property
    def place(self) -> Array:
        """(3,) where the joint is dragged to [m]."""
        across = self.view.place(self.position + self.moved, self.start)
        return np.asarray(across + self.depth_m * self.sight)

    def show(self, take: PropertyGroup) -> None:
        """Show the posture that the drag has come to; nothing is keyed."""
        from ...core.poses.dragged import dragged

        pushed, floor_m = self.depth_m != 0.0, take.matching.known_floor_m
        self.shown = dragged(self.body, self.posture, self.joint, self.place, self.sight, pushed, floor_m)
        write_posture(take.armature, self.shown)

    def restore(self, take: PropertyGroup) -> None:
        """Give the actor the pose from which the drag began."""
        restore_pose(take.armature, self.pose)
        evaluated(take.armature)


class KEYMARK_OT_move_joint(BaseOperator, bpy.types.Operator):
    """Move a joint of the actor to a place; the limb follows, with its lengths and within its joint limits"""

    bl_label = "Move Joint"
    requirements = (need.actor, need.idle)

    joint: Choice(
        "Joint",
        "The joint; left and right are the performer's own",
        items=[(name, segment_title(name), "Move this joint") for name in HUMAN.point_names],
    )
    place: Vector("Place", "Where to, in the world", subtype="TRANSLATION", size=3)
    sight: Vector(
        "Line of Sight",
        "Direction in which the view looks: along it the joint may end up elsewhere",
        subtype="DIRECTION",
        size=3,
        default=(0.0, 1.0, 0.0),
    )
    pushed: Switch("In Depth", "Whether the place along the line of sight counts as much as across it")

    def run(self, context: Context) -> None:
        from ...core.poses.dragged import dragged

        take = active_take(context.scene)
        body, posture = shown_pose(take)
        sight = np.array(self.sight, dtype=np.float64)
        sight /= max(float(np.linalg.norm(sight)), 1e-9)
        place, floor_m = np.array(self.place), take.matching.known_floor_m
        moved = dragged(body, posture, self.joint, place, sight, self.pushed, floor_m)
        in_depth = self.pushed or _shows_depth(context, take, sight, place)
        if not in_depth:
            moved = put_right(context.scene, take, body, posture, moved, {self.joint: place}, self.joint)
        set_corrected(self, context, take, moved, in_depth)


ASIDE = np.cos(np.radians(10.0))
"""A view turned by more than this from the camera's shows depth: of a drag of 10 cm 17 mm or more."""


def _shows_depth(context: Context, take: PropertyGroup, sight: Array, place: Array) -> bool:
    """Whether a view that looks in a direction (3,) at a place shows the depth that the camera does not."""
    return take.camera is None or bool(camera_now(context.scene, take).sight(place) @ sight < ASIDE)


DONE = {"RET", "NUMPAD_ENTER", "SPACE"}
BACK = {"RIGHTMOUSE", "ESC"}
VIEWS = {*(f"NUMPAD_{digit}" for digit in range(10)), "NUMPAD_PERIOD", "ACCENT_GRAVE"}
"""Keys that change the view: depth is corrected from the side."""
LOOKING = {each for each in NAVIGATION if not each.endswith("_ARROW")}  # without those that change the frame
IDLE_KEYS = "Drag: Move Joint   |   Ctrl: In Depth   |   Shift: Precise   |   F: Flip Depth   |   Enter: Done"
WAITING_KEYS = "Enter: Store   |   Esc, Right Click: Take Back All   |   Ctrl Z: Take Back the Last"
HOVER_KEYS = "{joint}   |   {keys}"
DRAG_KEYS = "{joint}   |   Ctrl: In Depth, Up Is Away   |   Shift: Precise   |   Esc, Right Click: Cancel"


not_dragging = need.of_context(
    lambda context: not job_is_running(context, DRAGGING),
    "Joints can be dragged already; Enter in the viewport ends it",
)


class KEYMARK_OT_drag_joints(bpy.types.Operator):
    """Drag joints in the viewport, in depth with Ctrl; limbs follow. Enter stores it, Esc takes all back"""

    bl_idname = "keymark.drag_joints"
    bl_label = "Drag Joints"
    bl_options = {"REGISTER"}  # with UNDO Blender would give a flip within the tool no step of its own

    _drag: Any = None  # The running drag; Blender would evaluate a type named here
    _done: Any = ()  # Drags that are shown and not stored yet, in order
    _frame = 0.0  # where they were made
    _keyframes: Any = ()  # those of the take as they are stored
    _index = 0  # the frame's place among theirs
    _handles: Any = None

    @classmethod
    def poll(cls, context: Context) -> bool:
        return all_met(cls, context, need.actor, need.idle, not_dragging)

    def invoke(self, context: Context, event: Event) -> set[str]:
        context.scene.keymark.overlays.only_character = False
        Handles.drawn = self._handles = Handles()
        context.window_manager.modal_handler_add(self)
        self._show(context)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Nothing without a mouse: `keymark.move_joint` moves a joint from a script."""
        return {"CANCELLED"}

    def modal(self, context: Context, event: Event) -> set[str]:
        take = find_take(context.scene)
        if take is None or need.actor(context, TakeState(take)) is not None:
            self.cancel(context)
            return {"CANCELLED"}
        if (self._drag or self._done) and context.scene.frame_current_final != self._frame:
            self._drag, self._done = None, ()  # Blender has evaluated another pose
            self.report({"WARNING"}, f"The pose dragged at frame {self._frame:g} was not stored")
            self._show(context)
        if self._drag is None and need.idle(context, None) is not None:
            return {"PASS_THROUGH"}  # a job that was started meanwhile
        if self._drag is not None:
            return self._dragging(context, take, event)
        view = view_under(context, event.mouse_x, event.mouse_y)
        if event.type in ("MOUSEMOVE", "INBETWEEN_MOUSEMOVE"):
            self._hover(context, take, view, event)
            return {"PASS_THROUGH"}
        pressed = event.type if event.value == "PRESS" else ""
        if view is None and not self._done:  # buttons of a panel, the timeline, other editors
            return {"PASS_THROUGH"}
        if pressed in DONE or (view is None and pressed == "LEFTMOUSE"):
            stored = self._store(context, take)
            return stored if view is not None else stored | {"PASS_THROUGH"}
        if pressed in BACK:
            self.cancel(context)
            return {"CANCELLED"}
        undo = event.type == "Z" and (event.ctrl or event.oskey)
        if pressed == "LEFTMOUSE" and view is not None:
            self._hover(context, take, view, event)
            self._begin(context, take, view, event)
        elif undo and pressed and self._done and not event.shift:
            self._done.pop().restore(take)
            self._show(context)
        elif pressed == "F" and self._handles.hovered and not self._done:
            limb = limb_of(self._handles.hovered)
            with reported(self):
                call(bpy.ops.keymark.flip_depth, "EXEC_DEFAULT", True, limb=limb)
        else:
            # What goes to another frame or changes the keyframes waits until the pose is stored.
            free = (undo or event.type in NAVIGATION) if not self._done else event.type in LOOKING
            passed = free or event.type in VIEWS or event.type.startswith("TIMER")
            return {"PASS_THROUGH"} if passed else {"RUNNING_MODAL"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: Context) -> None:
        """End the tool; what is not stored is taken back. Blender calls this as well."""
        drags, self._drag, self._done = [*self._done, self._drag], None, ()
        take = find_take(context.scene) if context.scene is not None else None
        if drags[0] is not None and take is not None and take.armature is not None:
            drags[0].restore(take)
        Handles.drawn = None
        if context.window is not None:  # None while Blender closes it or opens another file
            context.workspace.status_text_set(None)
            context.window.cursor_modal_restore()
            redraw_editors(context, "VIEW_3D")
        redraw_sidebars_soon()

    def _store(self, context: Context, take: PropertyGroup) -> set[str]:
        drags, self._done = self._done, ()
        if drags:
            with reported(self):
                set_corrected(self, context, take, drags[-1].shown, any(each.in_depth for each in drags))
            bpy.ops.ed.undo_push(message=self.bl_label)  # all drags together are one step
        self.cancel(context)
        return {"FINISHED"} if drags else {"CANCELLED"}

    def _hover(self, context: Context, take: PropertyGroup, view: WorldInRegion | None, event: Event) -> None:
        hovered = None if view is None else nearest_joint(take, view, event.mouse_x, event.mouse_y)
        if hovered == self._handles.hovered:
            return
        self._handles.hovered = hovered
        if hovered is None:
            context.window.cursor_modal_restore()
        else:
            context.window.cursor_modal_set("SCROLL_XY")
        self._show(context)

    def _begin(self, context: Context, take: PropertyGroup, view: WorldInRegion, event: Event) -> None:
        joint = self._handles.hovered
        if joint is None:
            return
        with reported(self):
            body, posture = shown_pose(take)
            start = body.points(body.pose(posture))[HUMAN.point_names.index(joint)]
            position = view.position(start)
            if position is not None:
                if not self._done:
                    self._done, self._frame = [], context.scene.frame_current_final
                    keyed = TakeState(take).keyed.all
                    first = floor(min((*keyed, self._frame)))  # frames are counted from it
                    self._index, self._keyframes = round(self._frame - first), ()
                    if keyed:
                        frames = first + np.arange(ceil(keyed[-1]) - first + 1.0)
                        source = take.armature, take.keyframe_action, body, frames
                        self._keyframes = read_keyframes(context.scene, *source).keyframes
                pose, mouse = pose_of(take.armature), (event.mouse_x, event.mouse_y)
                self._drag = JointDrag(joint, view, start, position, body, posture, pose, mouse)

    def _dragging(self, context: Context, take: PropertyGroup, event: Event) -> set[str]:
        drag = self._drag
        if event.value == "PRESS" and event.type in BACK:
            self._drag = None
            drag.restore(take)
            self._show(context)
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._drag = None
            pushed = drag.depth_m != 0.0
            if drag.moved.any() or pushed:
                drag.in_depth = pushed or _shows_depth(context, take, drag.sight, drag.place)
                self._done.append(drag)
                if not any(each.in_depth for each in self._done):
                    with reported(self):  # shows the likeliest depth of what drags in the picture come to
                        places = {each.joint: each.place for each in self._done}
                        first = self._done[0].posture
                        drag.shown = put_right(
                            context.scene, take, drag.body, first, drag.shown, places, drag.joint
                        )
                        write_posture(take.armature, drag.shown)
            else:
                drag.restore(take)
            self._show(context)
        elif event.type == "MOUSEMOVE":
            drag.follow(event)
            drag.show(take)
            self._show(context)
        return {"RUNNING_MODAL"}

    def _show(self, context: Context) -> None:
        """Show the keys, and the path of the joint dragged last around this frame: before and after."""
        drag = self._drag or (self._done[-1] if self._done else None)
        self._handles.path = None
        if drag is not None and drag.shown is not None and self._keyframes:
            from ...core.poses.dragged import paths_through

            shown = window(self._index, 1 + max(self._index, self._keyframes[-1].index))
            where = self._keyframes, self._index
            self._handles.path = drag.joint, paths_through(drag.body, *where, drag.shown, drag.joint, shown)
        if self._drag is not None and drag is not None:
            words = DRAG_KEYS.format(joint=segment_title(drag.joint))
        else:
            words = WAITING_KEYS if self._done else IDLE_KEYS
            if self._handles.hovered:
                words = HOVER_KEYS.format(joint=segment_title(self._handles.hovered), keys=words)
        show_keys(context, words)
        redraw_editors(context, "VIEW_3D")


def nearest_joint(take: PropertyGroup, view: WorldInRegion, mouse_x: int, mouse_y: int) -> str | None:
    """The joint that a view shows nearest to the mouse; None if none is near."""
    mouse = np.array([mouse_x - view.region.x, mouse_y - view.region.y], dtype=np.float64)
    positions = [view.position(place) for place in joint_places(take.armature)]
    away = [np.inf if each is None else float(np.linalg.norm(each - mouse)) for each in positions]
    nearest = int(np.argmin(away))
    return HUMAN.point_names[nearest] if away[nearest] <= 18.0 * ui_scale() else None
