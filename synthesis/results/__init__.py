"""What comes of a search: which designs are returned, in which order, and the account of the rest."""
