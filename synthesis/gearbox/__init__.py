"""Gearboxes of several speeds: structures, tooth numbers, and the proof that they are the best."""
