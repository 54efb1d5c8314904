"""Verification of balanced rotors and linkages by the forces that they exert."""
