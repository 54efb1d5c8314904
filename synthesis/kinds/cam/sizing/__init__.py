"""Sizing of cams: critical points, the smallest feasible size, resolution of the profile."""
