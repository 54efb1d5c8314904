"""Second opinions: routes to the same facts that share no formula with the package."""
