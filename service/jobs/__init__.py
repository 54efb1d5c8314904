"""Jobs: their rows in the store, their states, and the processes that run them."""
