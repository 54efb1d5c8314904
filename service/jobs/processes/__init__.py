"""Processes with limits: request pools, stop flags, memory limits, death of the parent."""
