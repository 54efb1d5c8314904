"""How a job lives: its row, its states, and who runs it."""
