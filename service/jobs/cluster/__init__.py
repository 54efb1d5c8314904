"""Workers on several hosts: leases, recovery, and the notifications of PostgreSQL."""
