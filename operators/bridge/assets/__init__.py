"""Assets: what a browser shows of them, their .blend files and catalogs, and motions as assets."""
