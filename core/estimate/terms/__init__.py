"""The terms of the estimates' cost, one a file; `assembly` lists them. A new kind of evidence begins here."""
