"""Requests for cams: program, segments, followers, limits."""
