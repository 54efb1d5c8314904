"""Parts that all fits of a linkage share: the chart of its dimensions, the curve it traces, and constraints as
margins."""
