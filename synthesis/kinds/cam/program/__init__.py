"""Motion programs: composition of segments, optimal programs by convex programming, dual bounds."""
