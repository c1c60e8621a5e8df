"""What moves: rotations, the skeleton, the actor's sizes, postures, kinematics and body shape."""
