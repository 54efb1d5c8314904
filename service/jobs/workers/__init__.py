"""Workers that solve jobs: scheduling, worker processes, progress reports."""
