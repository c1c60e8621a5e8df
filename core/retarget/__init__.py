"""A motion given to a character: bones recognized, rest poses aligned, feet planted, hands that reach."""
