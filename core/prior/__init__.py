"""What is believed beforehand: keyframes and what lies between them, libraries, learning and transfer."""
