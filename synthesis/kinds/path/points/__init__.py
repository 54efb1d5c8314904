"""Linkages fitted to many points by least squares."""
