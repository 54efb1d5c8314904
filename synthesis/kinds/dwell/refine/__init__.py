"""Refinement of dwell linkages by linear programs."""
