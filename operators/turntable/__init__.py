"""The turntable: views of the actor from the front, from a side and all around, beside a reference clip."""

PROPERTIES = ("properties",)
MODULES = ("set_up_turntable", "remove_turntable", "show_view", "look_from_side", "panel")
