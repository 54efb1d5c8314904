"""Analyses of planar linkages: motion, forces, planes, targets."""
