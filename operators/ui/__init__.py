"""Properties and panels. Panels show what is there and never compute."""
