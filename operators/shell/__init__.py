"""How operators run: requirements, error reports, jobs and Esc; the base of panels; the takes of a scene."""

PROPERTIES = ("job_progress", "notes", "panel")
MODULES = ("results", "keyed_frames")
