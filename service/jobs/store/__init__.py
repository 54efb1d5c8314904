"""The tables of jobs: schema, states, statements, admission and the cache of finished jobs."""
