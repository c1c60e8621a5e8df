"""Points of the body seen in the picture: the pose network, detectors' files, and who the performer is."""
