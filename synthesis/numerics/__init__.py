"""Numerical tools that several tasks share."""
