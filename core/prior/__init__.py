"""What is believed beforehand: keyframes, and the prior between them."""
