"""The HTTP service: access control, jobs and batches, and the form of the answers."""
