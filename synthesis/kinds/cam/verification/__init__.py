"""Verification of cams: the follower laid against the finished profile."""
