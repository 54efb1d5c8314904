"""Fourbar function generators: closure equations, precision points, minimax approximation."""
