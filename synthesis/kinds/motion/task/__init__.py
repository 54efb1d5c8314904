"""The task of a motion search in unit coordinates: positions, regions, random points, ranking."""
