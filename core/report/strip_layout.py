"""What a list knows of every take's strip of pictures before any is drawn or loaded: its file and its size.

Apart from the drawing, which needs all of the estimate, so that a batch writes its page without.
"""

STRIP = "strip.jpg"
"""The picture that stands for the take in a list."""
PICTURES = 6
SIDE = 160
"""Side of one picture [px]; a list shows it at about half of that, sharp on screens of double density."""
GAP = 4
SIZE = (PICTURES * SIDE + (PICTURES - 1) * GAP, SIDE)
"""Width and height of every strip, so that a page knows them before it is loaded."""
