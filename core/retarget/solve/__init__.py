"""A performer's motion on a character: joints, floor, feet, hands and the way over the ground."""
