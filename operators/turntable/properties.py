"""Properties of a take's turntable: its cameras, and a reference clip to compare the motion with."""

import bpy

VIEWS = (
    ("FRONT", "Front", "The view of the actor's face"),
    ("SIDE", "Side", "The view of one of the actor's sides"),
    ("TURNING", "Turntable", "The view that goes round the actor"),
)


def _take_of(turntable: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    return next((take for take in turntable.id_data.keymark.takes if take.turntable == turntable), None)


def _is_no_footage(turntable: bpy.types.PropertyGroup, clip: bpy.types.MovieClip) -> bool:
    """Whether no take uses the clip: a reference is shifted in time, which footage must not be."""
    return all(take.clip != clip for take in turntable.id_data.keymark.takes)


def _reference_changed(turntable: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    show_chosen_reference(turntable)


def show_chosen_reference(turntable: bpy.types.PropertyGroup) -> None:
    """Show the reference clip behind the chosen view, and behind no other."""
    from ..bridge.turntable import show_reference

    take = _take_of(turntable)
    first = 1 if take is None or take.clip is None else take.clip.frame_start - take.clip.frame_offset
    for view, camera in (
        ("FRONT", turntable.front),
        ("SIDE", turntable.side),
        ("TURNING", turntable.turning),
    ):
        if camera is not None:
            chosen = turntable.reference if view == turntable.reference_view else None
            show_reference(camera, chosen, first + turntable.reference_offset)


class KEYMARK_PG_turntable(bpy.types.PropertyGroup):
    """Views of the actor from other sides."""

    collection: bpy.props.PointerProperty(
        name="Collection", description="The collection of the views' cameras", type=bpy.types.Collection
    )
    front: bpy.props.PointerProperty(
        name="Front", description="The camera in front of the actor", type=bpy.types.Object
    )
    side: bpy.props.PointerProperty(
        name="Side", description="The camera beside the actor", type=bpy.types.Object
    )
    turning: bpy.props.PointerProperty(
        name="Turntable", description="The camera that goes round the actor", type=bpy.types.Object
    )
    reference: bpy.props.PointerProperty(
        name="Reference",
        description="A clip of this performance or another, to compare the motion with",
        type=bpy.types.MovieClip,
        poll=_is_no_footage,
        update=_reference_changed,
    )
    reference_view: bpy.props.EnumProperty(
        name="Behind",
        description="The view that the reference is shown behind",
        items=VIEWS,
        default="SIDE",
        update=_reference_changed,
    )
    reference_offset: bpy.props.IntProperty(
        name="Offset",
        description="Frames from the footage's first frame to the reference's; negative: earlier",
        default=0,
        soft_min=-100,
        soft_max=100,
        update=_reference_changed,
    )


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_turntable,))
