"""Views of the actor from other sides than the footage's."""

PROPERTIES = ("properties",)
MODULES = ("set_up_turntable", "remove_turntable", "show_view", "panel")
