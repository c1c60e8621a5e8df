"""A detector of the user's: any program that is called with a clip and writes keypoints.

Nothing here imports Blender: the command line runs detectors in an ordinary Python too.
"""
