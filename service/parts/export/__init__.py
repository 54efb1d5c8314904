"""Files of parts: CAD formats, packages and the model of the viewer."""
