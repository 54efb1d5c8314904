"""Parallel motion: a link that a sixbar carries along a coupler curve without turning it."""
