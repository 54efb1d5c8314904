"""Linkages of any number of links, as dyads and triads: assembly, motion, branches, limits."""
