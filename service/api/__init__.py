"""The HTTP API: thin endpoints over :mod:`service.jobs`, with one format for all errors."""
