"""The prior: keyframes, the posture between them and its process noise, and priors of single frames."""
