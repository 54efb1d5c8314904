"""Corrections of rotors."""
