"""Requests for motions: positions, dyad choices, mechanism types, contradictions."""
