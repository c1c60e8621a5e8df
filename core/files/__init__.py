"""Trustworthy reading and writing of files: strict JSON, checked fields, folders committed as a whole.

What reads raises `InputError` with one sentence that names file, field, value and what would be valid; what
writes raises `ConversionError`.
"""
