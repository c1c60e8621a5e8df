"""A reconstructed motion made ready for an animator: feet that stand still, and few keys."""
