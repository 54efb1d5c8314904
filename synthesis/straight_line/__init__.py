"""Straight lines: linkages whose coupler point follows one, approximately or exactly."""
