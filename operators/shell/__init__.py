"""How operators run: jobs, requirements, messages, the base of panels, and the take they are about."""

PROPERTIES = ("progress_properties",)
MODULES = ("results", "keyed_frames")
