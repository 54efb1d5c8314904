"""Alembic migrations of the job store's tables."""
