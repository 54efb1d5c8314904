"""Verification of function generators by driving them."""
