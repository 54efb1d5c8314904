"""The command line: serve, solve, analyze, draw, demo and others."""
