"""The shipped keyframe libraries as they are composed, for make_libraries.py.

`moment` says a body in the words of a clinic, `solving` makes a posture of it, `composing` collects them
and motions; `gait` and `run` know how feet and hips go together, `balance` where the mass is, `placing`
where a moment stands. Every module of `kinds` composes one library; `inspection` finds what is wrong with it.
"""
