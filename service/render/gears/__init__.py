"""Drawings of gear trains and gearboxes."""
