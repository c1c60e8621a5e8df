"""What the commands of `keymark library` do."""
