"""Sources of the shipped keyframe libraries, for make_libraries.py.

`moment` describes a body in clinical terms, `solving` computes its posture, `composing` collects postures and
motions; `gait` and `run` coordinate feet and hips, `balance` computes the center of mass, `placing` moves a
moment over the floor. Every module of `kinds` composes one library; `inspection` finds its faults.
"""
