"""Makes what the studio shows before anybody has asked for anything, from the answers of a running service."""
