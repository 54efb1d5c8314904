"""Who may ask, how a job lives, how an answer looks: the HTTP service."""
