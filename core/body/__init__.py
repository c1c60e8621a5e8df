"""The body model: rotations, skeleton, joint limits, actor, postures, kinematics and volume."""
