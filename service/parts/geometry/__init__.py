"""Geometry of parts: plane regions, arcs, splines, solids and their triangulation."""
