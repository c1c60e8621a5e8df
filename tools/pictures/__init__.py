"""The pictures of the docs, for draw_pictures.py: what each shows, and how it is made."""
