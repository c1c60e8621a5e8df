"""Pictures of a result, drawn with OpenCV: speed, the skeleton over the footage, other views."""
