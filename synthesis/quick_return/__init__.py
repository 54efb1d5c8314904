"""Quick return: mechanisms with a given time ratio."""
