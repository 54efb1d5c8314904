"""Requests for balancing: rotors, counterweights and their contradictions."""
