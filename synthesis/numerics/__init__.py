"""Numerical methods that several kinds of problems share."""
