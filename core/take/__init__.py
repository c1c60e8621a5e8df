"""One recorded performance: the take, its files and settings, and what a conversion of it leaves."""
