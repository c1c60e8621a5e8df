"""A room: a wooden floor, two walls, furniture, lamps, and other things that stand or move."""

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from .surroundings import WALL_BEHIND_Y, WALL_RIGHT_X, Lamp, Room, Thing, Triple

SKIRTING = (0.80, 0.79, 0.76)
WOOD = (0.30, 0.20, 0.12)
GRAY = (0.24, 0.25, 0.27)
DARK = (0.07, 0.07, 0.08)
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BuiltRoom:
    """A room in Blender's scene."""

    things: tuple[bpy.types.Object, ...]
    """Blender's objects for the room's things."""
    room: Room
    """The description they were made from."""

    @property
    def moving(self) -> list[bpy.types.Object]:
        """Blender's objects for the moving things."""
        return [
            thing for thing, described in zip(self.things, self.room.things, strict=True) if described.moves
        ]

    def move(self, frame: float) -> None:
        """Move all things to their positions at a frame."""
        for thing, described in zip(self.things, self.room.things, strict=True):
            thing.location = described.place(frame)

    def moving_places(self, frame: float) -> Array:
        """(N, 3) corners of the moving things [m]."""
        corners = 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        moving = [thing for thing in self.room.things if thing.moves]
        return np.concatenate(
            [np.zeros((0, 3)), *(thing.place(frame) + corners * thing.size for thing in moving)]
        )


def build_room(room: Room) -> BuiltRoom:
    """Add the room to the scene; the performer has about 3 m by 3 m."""
    _floor(room.planks)
    wall = _matt("Wall", room.wall, uneven=0.06)
    _box("Wall behind", (0.0, WALL_BEHIND_Y + 0.05, 1.5), (9.0, 0.1, 3.6), wall)
    _box("Wall right", (WALL_RIGHT_X - 0.05, -1.5, 1.5), (0.1, 8.0, 3.6), wall)
    skirting = _matt("Skirting", SKIRTING)
    _box("Skirting behind", (0.0, WALL_BEHIND_Y - 0.01, 0.06), (9.0, 0.03, 0.12), skirting)
    _box("Skirting right", (WALL_RIGHT_X + 0.01, -1.5, 0.06), (0.03, 8.0, 0.12), skirting)
    if room.furnished:
        _wall_bars(-1.55, WALL_BEHIND_Y - 0.09)
        _pictures()
        _bench(2.0, WALL_BEHIND_Y - 0.38)
        _ball((-2.25, 1.05, 0.30), 0.30, _matt("Ball", (0.32, 0.34, 0.36)))
    for lamp in room.lamps:
        _light(lamp)
    world = bpy.data.worlds.new("Room light")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*room.sky[:3], 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = room.sky[3]
    bpy.context.scene.world = world
    return BuiltRoom(tuple(_thing(thing) for thing in room.things), room)


def _thing(thing: Thing) -> bpy.types.Object:
    place = tuple(float(value) for value in thing.place(0.0))
    material = _matt("Thing", thing.color, uneven=0.1, scale=4.0)
    if thing.round:
        return _ball(place, 0.5 * thing.size[0], material)
    return _box("Thing", place, thing.size, material)


def _floor(planks: tuple[Triple, Triple, Triple]) -> None:
    floor = _box("Floor", (0.0, -1.5, -0.05), (9.0, 8.0, 0.1), _matt("Floor", WOOD))
    material = floor.data.materials[0]
    nodes, links = material.node_tree.nodes, material.node_tree.links
    bricks, place = nodes.new("ShaderNodeTexBrick"), nodes.new("ShaderNodeTexCoord")
    for name, color in zip(("Color1", "Color2", "Mortar"), planks, strict=True):
        bricks.inputs[name].default_value = (*color, 1.0)
    for name, value in (("Scale", 1.0), ("Brick Width", 1.6), ("Row Height", 0.16), ("Mortar Size", 0.004)):
        bricks.inputs[name].default_value = value
    links.new(place.outputs["Object"], bricks.inputs["Vector"])
    links.new(bricks.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.5


def _wall_bars(x: float, y: float) -> None:
    wood = _matt("Bars", (0.42, 0.31, 0.20))
    for side in (-0.45, 0.45):
        _box("Bar post", (x + side, y, 1.15), (0.05, 0.12, 2.3), wood)
    for height in np.arange(0.25, 2.25, 0.22):
        _box("Bar", (x, y - 0.03, float(height)), (0.9, 0.035, 0.035), wood)


def _pictures() -> None:
    frame, paper = _matt("Frame", DARK), _matt("Paper", (0.55, 0.54, 0.50), uneven=0.5, scale=6.0)
    for x, z, width, height in ((1.15, 1.75, 0.62, 0.44), (1.95, 1.62, 0.40, 0.54)):
        _box("Frame", (x, WALL_BEHIND_Y - 0.015, z), (width, 0.03, height), frame)
        _box("Paper", (x, WALL_BEHIND_Y - 0.035, z), (width - 0.07, 0.02, height - 0.07), paper)


def _bench(x: float, y: float) -> None:
    _box("Bench", (x, y, 0.44), (1.3, 0.34, 0.07), _matt("Bench", GRAY))
    for side in (-0.5, 0.5):
        _box("Bench leg", (x + side, y, 0.2), (0.07, 0.28, 0.4), _matt("Leg", DARK))


def _ball(place: Triple, radius: float, material: bpy.types.Material) -> bpy.types.Object:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=radius, location=place)
    ball = bpy.context.object
    ball.data.materials.append(material)
    bpy.ops.object.shade_smooth()
    return ball


def _box(name: str, place: Triple, size: Triple, material: bpy.types.Material) -> bpy.types.Object:
    corners = 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners.tolist(), [], faces)
    mesh.materials.append(material)
    thing = bpy.data.objects.new(name, mesh)
    thing.location = place
    bpy.context.scene.collection.objects.link(thing)
    return thing


def _matt(name: str, color: Triple, uneven: float = 0.0, scale: float = 1.5) -> bpy.types.Material:
    """A matte material; `uneven` is the spatial variation of its brightness."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = 0.8
    if uneven:
        noise, ramp = nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeValToRGB")
        noise.inputs["Scale"].default_value = scale
        for element, factor in zip(ramp.color_ramp.elements, (1.0 - uneven, 1.0 + uneven), strict=True):
            element.color = (*(min(1.0, factor * value) for value in color), 1.0)
        links.new(noise.outputs["Fac"], ramp.inputs["Fac"])
        links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
    return material


def _light(lamp: Lamp) -> None:
    light = bpy.data.lights.new("Window", "AREA")
    light.size, light.energy, light.color = lamp.size, lamp.power, lamp.color
    thing = bpy.data.objects.new("Window", light)
    thing.location = lamp.place
    towards = Vector((0.2, 0.0, 1.0)) - Vector(lamp.place)
    thing.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)
