"""The command line: serve, solve, analyze, draw, demo."""
