"""How operators run: jobs, requirements, messages, the base of panels, and the take they are about."""

PROPERTIES = ("job_progress",)
MODULES = ("results", "keyed_frames")
