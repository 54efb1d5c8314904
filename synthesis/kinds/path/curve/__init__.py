"""Linkages matched to a whole curve."""
