"""Driver dyads: a crank and a link added to a fourbar, or to its coupler."""
