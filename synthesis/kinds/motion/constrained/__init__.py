"""Constrained fits: tolerances are used to satisfy all constraints at once."""
