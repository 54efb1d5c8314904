"""Dynamics of cams: overturning of the follower and vibration of its train."""
