"""How good a motion is: confidence, frames worth another keyframe, the review, the score against a truth."""
