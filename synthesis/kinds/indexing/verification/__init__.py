"""Verification of Geneva drives and ratchets."""
