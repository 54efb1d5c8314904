"""Drawings of flywheels, engines, indexing drives and ratchets."""
