"""Conversion of one take into one complete folder of results."""
