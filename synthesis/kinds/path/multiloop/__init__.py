"""Sixbars and eightbars that draw a path."""
