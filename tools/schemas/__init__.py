"""JSON Schemas made of declarations, for make_schemas.py."""
