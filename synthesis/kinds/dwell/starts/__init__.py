"""Starting linkages of the search for dwells."""
