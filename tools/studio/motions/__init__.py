"""Motions of people, composed for takes: each module has `plan(body, times_s, random)`."""
