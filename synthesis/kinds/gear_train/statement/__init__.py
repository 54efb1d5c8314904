"""Requests for gear trains: stages, ranges of teeth, contradictions."""
