"""Modules shared by all fits of a linkage: the chart of its dimensions, the curve it traces, constraints as margins."""
