"""How the service speaks HTTP: thin endpoints over :mod:`service.jobs`, and one manner of saying what went wrong."""
