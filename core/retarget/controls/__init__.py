"""Controls of a character: in which space they act, their channels, and few keys on all of them."""
