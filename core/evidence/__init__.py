"""Measurement models: what a posture predicts of the footage, with Jacobians."""
