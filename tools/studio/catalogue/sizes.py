"""Sizes of images [px]."""

SMALL, MIDDLE, WIDE = (320, 240), (640, 360), (1280, 720)
