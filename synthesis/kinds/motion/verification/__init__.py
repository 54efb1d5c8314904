"""Verification of linkages at the requested positions."""
