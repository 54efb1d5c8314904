"""Residuals and constraints of path fits."""
