"""Analyses of gear pairs, trains and gearboxes."""
