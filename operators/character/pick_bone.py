"""The bone of a character under the mouse, in any 3D viewport of the window."""

import bpy
import numpy as np
from bpy.types import Context, Event, Object, OperatorProperties, PoseBone, PropertyGroup
from bpy_extras.view3d_utils import location_3d_to_region_2d

from ...core.arrays import Array
from ...core.errors import MOST_NAMED, InputError
from ...core.files.fields import listed
from ...core.retarget.character import CHAINS
from ..bridge.character.read_character import read_character
from ..shell import need
from ..shell.base_operator import BaseOperator, reported
from ..shell.fields import SKIP_SAVE, Choice, Text
from ..shell.footage_view import NAVIGATION, FootageRequest, ask, follow_mouse, stop_asking
from ..shell.job_operator import cancel_click
from .characters import active_character, armature, find_character, full_title
from .map_properties import map_of, role_named, show_map
from .recognition import RoleBoneOperator, active_bone_of, give_bone, role_words

NEAR_PX = 25.0  # farthest that a click may be from a bone, at a UI scale of 1
ENTER, ESCAPE = "Enter: {bone}, the active one   |   ", "Esc: Cancel"
SAME_PX = 3.0  # farther than the nearest by this, bones lie over it: the front one counts


def bone_under(context: Context, armature_object: Object, mouse_x: int, mouse_y: int) -> str | None:
    """Name of the visible bone nearest to the mouse [window px], in a 3D viewport; None where none is."""
    areas = (area for area in context.screen.areas if area.type == "VIEW_3D")
    regions = (region for area in areas for region in area.regions if region.type == "WINDOW")
    for region in regions:
        if 0 <= mouse_x - region.x < region.width and 0 <= mouse_y - region.y < region.height:
            break
    else:
        return None
    view, names, ends, depths = region.data, [], [], []
    shown = armature_object.evaluated_get(context.evaluated_depsgraph_get())
    for bone in filter(is_visible, shown.pose.bones):
        places = [shown.matrix_world @ end for end in (bone.head, bone.tail)]
        pixels = [location_3d_to_region_2d(region, view, place) for place in places]
        if all(pixel is not None for pixel in pixels):
            names.append(bone.name)
            ends.append([tuple(pixel) for pixel in pixels])
            depths.append(-(view.view_matrix @ ((places[0] + places[1]) / 2.0)).z)
    if not names:
        return None
    mouse = np.array([mouse_x - region.x, mouse_y - region.y], dtype=np.float64)
    near = NEAR_PX * context.preferences.system.ui_scale
    index = nearest_segment(mouse, np.array(ends, dtype=np.float64), np.array(depths), near)
    return None if index is None else names[index]


def nearest_segment(point: Array, ends: Array, depths: Array, near: float) -> int | None:
    """Index of the segment (N, 2, 2) near a point [px], the front one of several; None if none is."""
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    squared = np.maximum(np.sum(along**2, axis=1), 1e-12)
    share = np.clip(np.sum((point - start) * along, axis=1) / squared, 0.0, 1.0)
    distance = np.linalg.norm(start + share[:, None] * along - point, axis=1)
    if distance.min() > near:
        return None
    level = np.flatnonzero(distance <= distance.min() + SAME_PX)
    return int(level[np.argmin(depths[level])])


def is_visible(pose_bone: PoseBone) -> bool:
    """Whether the viewport shows a bone: not hidden, and in a visible collection or in none."""
    bone = pose_bone.bone
    if bone.hide or getattr(pose_bone, "hide", False):  # Blender 5 hides pose bones, 4.5 bones
        return False
    return not len(bone.collections) or any(each.is_visible_effectively for each in bone.collections)


class KEYMARK_OT_pick_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Click on the bone in the viewport"""

    bl_label = "Pick Bone"
    requirements = (armature, need.idle)

    bone: Text("Bone", "Name of the bone", options=SKIP_SAVE)

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        known = role_words(context, properties.role)
        advice = "Click on the bone in the viewport to choose it"
        return f"{known}. {advice}" if known else advice

    def invoke(self, context: Context, event: Event) -> set[str]:
        if self.bone or bpy.app.background:
            return self.execute(context)
        self._ask(context, "")
        context.window_manager.keymark_progress.show("", 0.0)
        context.window.cursor_modal_set("EYEDROPPER")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: Event) -> set[str]:
        if cancel_click(self, context, event):
            return {"CANCELLED"}
        follow_mouse(context, event)
        pressed = event.value == "PRESS"
        confirmed = pressed and event.type in ("RET", "NUMPAD_ENTER")
        clicked = pressed and event.type == "LEFTMOUSE"
        if not clicked and not confirmed and event.type != "MOUSEMOVE":
            return {"PASS_THROUGH"} if event.type in NAVIGATION else {"RUNNING_MODAL"}
        character = find_character(context.scene)
        if character is not None and character.armature is not None:
            with reported(self):
                if confirmed:
                    return self._take(context, active_bone_of(character))
                under = bone_under(context, character.armature, event.mouse_x, event.mouse_y)
                if clicked:
                    return self._take(context, under)
                self._ask(context, under or "")
                return {"PASS_THROUGH"}
        self.cancel(context)
        return {"CANCELLED"}

    def _take(self, context: Context, bone: str | None) -> set[str]:
        if bone is None:
            self.report({"WARNING"}, "That is no bone of the character; click on one")
            return {"RUNNING_MODAL"}
        self.bone = bone
        self.cancel(context)
        return self.execute(context)

    def _ask(self, context: Context, under: str) -> None:
        request = FootageRequest(f"Click on the bone: {full_title(self.role)}", under, of_footage=False)
        active = active_bone_of(active_character(context.scene))
        ask(context, request, ENTER.format(bone=active) + ESCAPE if active is not None else ESCAPE)

    def cancel(self, context: Context) -> None:
        stop_asking(context)

    def run(self, context: Context) -> None:
        if not self.bone:
            raise InputError("no bone is chosen; click on one in Pose Mode, or give its name")
        give_bone(active_character(context.scene), self.role, self.index, self.bone)


class KEYMARK_OT_add_chain_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Add the next bone upward to the chain"""

    bl_label = "Add Bone"
    requirements = (armature,)

    def run(self, context: Context) -> None:
        character = active_character(context.scene)
        shown = chain_of(character, self.role)
        taken = {entry.bone for role in character.character_map.roles for entry in role.bones}
        last = shown.bones[-1].bone if len(shown.bones) else ""
        below = character.armature.data.bones.get(last)
        free = [child for child in below.children if child.name not in taken] if below is not None else []
        # The child that goes on from the bone's tail and plays no role yet.
        onward = min(free, key=lambda child: (child.head_local - below.tail_local).length, default=None)
        shown.bones.add().bone = onward.name if onward is not None else ""


class KEYMARK_OT_remove_chain_bone(RoleBoneOperator, BaseOperator, bpy.types.Operator):
    """Take this bone out of the chain; its turn goes to the others"""

    bl_label = "Remove Bone"
    requirements = (armature,)

    def run(self, context: Context) -> None:
        shown = chain_of(active_character(context.scene), self.role)
        count = len(shown.bones)
        if self.index >= count:
            raise InputError(f"the role {self.role} has {count} bones; there is no number {self.index}")
        if count == 1:
            shown.bones[0].bone = ""
            return
        shown.bones.remove(self.index)
        shown.source, shown.confidence, shown.doubt, shown.uneven = "you", 1.0, "", False


def chain_of(character: PropertyGroup, role: str) -> PropertyGroup:
    """The properties of a role that several bones may share.

    Raises:
        InputError: It is one bone's.
    """
    if role not in CHAINS:
        raise InputError(f"'{role}' is no chain of bones; spine, neck and fingers are")
    return role_named(character.character_map, role)


SIDES = (
    ("L", "Left to Right", "Copy the bones of the left arm and leg to the right"),
    ("R", "Right to Left", "Copy the bones of the right arm and leg to the left"),
)


class KEYMARK_OT_mirror_roles(BaseOperator, bpy.types.Operator):
    """Copy the bones and controls of one side's arm and leg to the other, by mirrored names and places"""

    bl_label = "Mirror"
    requirements = (armature, need.idle)

    side: Choice("Direction", "Which side is copied", items=SIDES)

    def run(self, context: Context) -> set[str] | None:
        from ...core.retarget.maps.map_registry import mirrored_map

        character = active_character(context.scene)
        before = map_of(character.character_map)
        after, missing = mirrored_map(read_character(character.armature), before, self.side)
        if missing:
            names = listed(map(full_title, missing), MOST_NAMED)
            self.report({"WARNING"}, f"No bones were found that mirror those for {names}")
        if after == before:
            return {"CANCELLED"}
        doubts = {
            role.name: role.doubt
            for role in character.character_map.roles
            if role.doubt and after.roles.get(role.name) == before.roles.get(role.name)
        }
        show_map(character.character_map, after, doubts)
        return None
