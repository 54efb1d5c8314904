"""Results of a search: selection and order of the designs, and the account of rejected candidates."""
