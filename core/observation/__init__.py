"""What a posture predicts of the observations, with Jacobians."""
