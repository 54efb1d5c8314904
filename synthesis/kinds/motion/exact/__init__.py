"""Linkages through exact positions: pairs of dyads, screening, workspace and force filters."""
