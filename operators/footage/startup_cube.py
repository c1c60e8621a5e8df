"""The cube of Blender's startup file, which stands where the performer does."""

import bpy

NAME, CORNERS = "Cube", 8
SIZE_M = 2.0


def hide_startup_cube(context: bpy.types.Context) -> None:
    """Hide the cube of Blender's startup file, where nobody has touched it; Alt H brings it back."""
    cube = context.view_layer.objects.get(NAME)
    if cube is not None and _is_untouched(cube):
        cube.hide_set(True)


def _is_untouched(cube: bpy.types.Object) -> bool:
    plain = cube.type == "MESH" and len(cube.data.vertices) == CORNERS and not len(cube.modifiers)
    same_size = all(abs(length - SIZE_M) < 1e-4 for length in cube.dimensions)
    return bool(plain and same_size and cube.location.length < 1e-4 and cube.animation_data is None)
