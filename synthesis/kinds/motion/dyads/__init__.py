"""Dyads through positions: equations, Burmester curves, finite sets and sliders."""
