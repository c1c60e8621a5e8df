"""Properties, panels and what is drawn over the editors."""
