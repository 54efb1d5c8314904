"""Gears: teeth and meshes, ordinary and planetary trains."""
