"""Outcomes of takes in a batch: results and failures, written beside each other and read again."""
