"""What a scene holds of its takes: finding, filling and keeping them."""
