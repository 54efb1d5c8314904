"""Dwells: sixbars whose output rests while the crank turns on."""
