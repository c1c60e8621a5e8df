"""What the whole-clip estimate weighs against each other, one term a file."""
