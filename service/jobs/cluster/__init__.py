"""Workers on several hosts: leases, recovery, and the listener for PostgreSQL notifications."""
