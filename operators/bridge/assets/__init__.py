"""Assets: their details, .blend files and catalogs, and motions as assets."""
