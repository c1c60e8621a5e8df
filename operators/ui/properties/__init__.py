"""What Keymark stores in a file: one group of properties a file, the scene's own last."""
