"""The proof of a design: it is driven by the analysis core and measured, from its dimensions alone."""
