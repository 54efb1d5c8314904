"""Function generation: precision points, least squares and minimax."""
