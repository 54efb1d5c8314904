"""What every fit of a linkage shares: the chart of its dimensions, the curve it traces, and demands as inequalities."""
