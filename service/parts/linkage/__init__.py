"""Parts of linkages: links, pins, gears and their motion."""
