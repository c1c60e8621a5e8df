"""Pictures of a result, drawn with OpenCV: the skeleton over the footage, the side view, characters."""
