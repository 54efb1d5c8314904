"""Workers that solve jobs: scheduling, worker processes and their progress."""
