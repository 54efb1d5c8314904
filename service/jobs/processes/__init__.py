"""Processes with limits: request pools, stop flags, memory limits, detection of a dead parent."""
