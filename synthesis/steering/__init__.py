"""Steering: linkages and gears between two stub axles."""
