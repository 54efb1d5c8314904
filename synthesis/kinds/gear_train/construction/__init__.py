"""Gear trains as answers: gears, meshes and the power that they carry."""
