"""Masses, loads, springs and forces in requests and answers."""
