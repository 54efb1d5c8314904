"""Drawings of linkages."""
