"""Results of a search: selection, order and measurement of the designs, and the log of rejected candidates."""
