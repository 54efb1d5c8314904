"""Requests for functions: the function and the mechanism types."""
