"""Output motion of dwell linkages, the intervals of rest, and their score."""
