"""Drawings of cams."""
