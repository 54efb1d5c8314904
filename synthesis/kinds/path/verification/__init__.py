"""Verification of paths: passages of points, excursion, cognates, stance."""
