"""Linkages fitted to many positions by least squares."""
