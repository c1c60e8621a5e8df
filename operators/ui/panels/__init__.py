"""The sidebar, one step of the work a file. Panels show what is there and never compute."""
