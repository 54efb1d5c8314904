"""Linkages in requests and answers: constraints, workspace, zones, targets."""
