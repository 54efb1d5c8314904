"""Path generation: linkages whose coupler point goes through points or along a curve."""
