"""Sixbars that draw a path."""
