"""A new `shoot.json`, filled in from a survey of its clips."""
