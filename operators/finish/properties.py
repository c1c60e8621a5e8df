"""Properties of the finish: options and result of the final Action, and details of the asset."""

import bpy

KEYS = (
    ("TOLERANCE", "Within Tolerance", "As few keys as keep the body within the tolerance in every frame"),
    ("EVERY_FRAME", "Every Frame", "A key on every frame, as reconstructed"),
)
SHARED = (
    ("PER_BONE", "Per Bone", "Each bone has keys where it needs them; the fewest keys"),
    ("WHOLE_POSE", "Whole Pose", "All bones have keys on the same frames, pose by pose"),
)


class KEYMARK_PG_finish(bpy.types.PropertyGroup):
    """Finish of a take's motion."""

    keys: bpy.props.EnumProperty(name="Keys", description="Number of keys of the final Action", items=KEYS)
    tolerance_mm: bpy.props.FloatProperty(
        name="Tolerance (mm)",
        description="Largest distance of any joint or end of the body from the reconstructed motion",
        default=5.0,
        min=0.1,
        soft_min=1.0,
        soft_max=50.0,
        max=500.0,
        precision=1,
        step=50,
    )
    shared: bpy.props.EnumProperty(
        name="Keyed", description="Whether bones are keyed each on its own or together", items=SHARED
    )
    plant_feet: bpy.props.BoolProperty(
        name="Plant Feet",
        description="Hold resting feet at one place; the legs follow, and the hips a little where they must",
        default=True,
    )
    stray_mm: bpy.props.FloatProperty(
        name="Feet May Sway (mm)",
        description="Distance that a resting foot may stray and still be held; raise it to hold swaying feet",
        default=25.0,
        min=1.0,
        soft_max=100.0,
        max=500.0,
        precision=0,
        step=100,
    )
    action: bpy.props.PointerProperty(
        name="Final",
        description="The Action that holds the finished motion, in keys of your own to edit",
        type=bpy.types.Action,
    )
    outdated: bpy.props.BoolProperty(
        name="Outdated",
        description="Whether the motion was reconstructed again after the final Action was made",
        options={"HIDDEN"},
    )
    keys_before: bpy.props.IntProperty(name="Keys Before", options={"HIDDEN"})
    keys_after: bpy.props.IntProperty(name="Keys After", options={"HIDDEN"})
    furthest_mm: bpy.props.FloatProperty(name="Furthest", options={"HIDDEN"})
    rests: bpy.props.IntProperty(name="Rests", options={"HIDDEN"})
    catalog: bpy.props.StringProperty(
        name="Catalog",
        description="Catalog of the motion in the asset browser, such as Keymark/Walking; empty for none",
        default="Keymark/Motions",
    )
    tags: bpy.props.StringProperty(
        name="Tags", description="Words to find the motion by, with commas between them", default="keymark"
    )
    author: bpy.props.StringProperty(name="Author", description="Author of the motion")
    license: bpy.props.StringProperty(
        name="License", description="Terms under which others may use the motion"
    )
    description: bpy.props.StringProperty(name="Description", description="Description of the motion")


register, unregister = bpy.utils.register_classes_factory((KEYMARK_PG_finish,))
