"""Sixbars that carry a body through positions."""
