"""Finding a library's postures in footage: a hidden Markov model over postures and headings."""
