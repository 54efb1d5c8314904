"""Motion programs of cams: laws, segments, piecewise functions and their exact extremes."""
