"""The studio that films takes with truth for make_takes.py: motions, performers, rooms, cameras."""
