"""Linkages exactly through three to nine points."""
