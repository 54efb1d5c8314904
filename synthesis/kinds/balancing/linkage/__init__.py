"""Counterweights of linkages: exact force and moment balance, and the convex minimum."""
