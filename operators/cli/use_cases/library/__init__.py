"""`keymark library`: its words, its commands, and where libraries are found."""
