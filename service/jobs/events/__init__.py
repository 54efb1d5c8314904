"""Notification of changes to jobs: in one process, and by polling the store."""
