"""The shipped libraries: one module each, called as the library is, with a function `library`."""
