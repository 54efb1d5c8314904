"""Finished cams measured from the points of their profiles alone: contact, curvature, extreme values."""
