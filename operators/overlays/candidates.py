"""Overlay of a candidate: a posture that a found keyframe's frame may show, as a faint figure.

It is the one whose button the mouse was over last, in the button's color and with its number, over the
footage and from any other side, where depth shows. The one that the frame has is the actor itself.
"""

import bpy
import numpy as np
from bpy.types import Context, PropertyGroup

from ...core.arrays import Array
from ...core.body.human import HUMAN
from ..shell.results import LruCache
from ..shell.take_state import TakeState
from ..shell.takes import find_take, redraw_footage
from . import drawing
from .drawing import CANDIDATE_COLORS, CORE, GHOST, TALL_M, Item, Label, Stroke, Style, body_scale, faded
from .figures import limb_lines
from .views import motion_view

_points: "LruCache[Array]" = LruCache()
"""(N, 13, 3) points of a found keyframe's candidates, by what they depend on."""
_looked_at: tuple[float, int] = (np.nan, 0)
"""Scene frame, and the candidate there whose button the mouse was over last."""


def look_at(context: Context, candidate: int) -> None:
    """Draw a candidate of the current frame; called where Blender asks for the tooltip of its button."""
    global _looked_at
    wanted = float(context.scene.frame_current_final), candidate
    if wanted != _looked_at:
        _looked_at = wanted
        redraw_footage(context)


def draw(context: Context) -> list[Item]:
    """The figure of the candidate, at a frame that nobody has decided on."""
    scene = context.scene
    settings, take = scene.keymark.overlays, find_take(scene)
    if take is None or not settings.show_candidates or context.screen.is_animation_playing:
        return []
    frame, candidate = _looked_at
    state = TakeState(take)
    if frame != scene.frame_current_final or take.armature is None or not state.shows_keyframes:
        return []
    place, view = state.match_at(frame), motion_view(context, take)
    match = take.matching.matches[place] if place >= 0 else None
    if match is None or len(match.candidates) < 2 or state.of_match(match) != "FOUND":
        match = state.offered_at(frame)
    # The frame may have got other candidates since.
    if match is None or view is None or candidate == match.chosen or candidate >= len(match.candidates):
        return []
    positions = view.project(candidate_points(take.armature, match))
    return picture(positions, candidate, match.chosen, settings)


def candidate_points(armature_object: bpy.types.Object, match: PropertyGroup) -> Array:
    """(N, 13, 3) points of a found keyframe's candidates in the world."""
    places = [[*candidate.place, *candidate.turns] for candidate in match.candidates]
    lengths = [bone.length for bone in armature_object.data.bones]
    key = f"{armature_object.session_uid} {lengths} {tuple(armature_object.scale)} {places}"

    def found() -> Array:
        from ..bridge.actor_lengths import read_body
        from ..bridge.keyframes import candidate_posture

        body = read_body(armature_object)
        return np.stack([body.points(body.pose(candidate_posture(each))) for each in match.candidates])

    points = _points.known(key, found)
    assert points is not None
    return points


def picture(positions: Array, candidate: int, chosen: int, settings: PropertyGroup) -> list[Item]:
    """The figure of a candidate, with its number where it is farthest from the chosen one.

    `positions` (N, 13, 2) are region pixels of all candidates' points, NaN where not seen.
    """
    scale, figure = drawing.ui_scale(), positions[candidate]
    tall_px = float(np.ptp(np.nan_to_num(figure[:, 1])))
    style = Style(settings.opacity, scale, body_scale(np.array([tall_px / TALL_M]), scale))
    width = style.limb * style.width * style.body_scale
    themed = bpy.context.preferences.themes[0].collection_color[candidate % CANDIDATE_COLORS].color
    color = style.color(faded(themed, GHOST))
    lines, sides = limb_lines(HUMAN.point_names, figure)
    items: list[Item] = [
        Stroke(lines, color, width, GHOST * style.halo),
        Stroke(lines[sides == "R"], style.color(CORE), style.core * width),
    ]
    apart = np.nan_to_num(np.linalg.norm(figure - positions[chosen], axis=-1), nan=-1.0)
    if apart.max() >= 0.0:
        x, y = figure[apart.argmax()]
        items.append(Label(str(candidate + 1), float(x), float(y) + 6.0 * scale, (*color[:3], 1.0), "middle"))
    return items
