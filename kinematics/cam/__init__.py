"""Cams: motion laws, programs, followers, profiles, contact and follower dynamics."""
