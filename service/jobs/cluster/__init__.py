"""Workers on several hosts: leases, recovery, the broker and the listener of PostgreSQL."""
