"""Analyses of cams."""
