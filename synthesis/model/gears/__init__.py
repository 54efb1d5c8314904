"""Gears in requests and answers: ratios, stages, limits of meshes, strength."""
