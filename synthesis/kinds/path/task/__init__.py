"""The task of a path search: target curve and ranking."""
