"""Cams: the motion program that is best by a criterion, the smallest cam that carries it, and their proof."""
