"""Workers on several hosts: leases, recovery, the broker, and the listener for PostgreSQL notifications."""
