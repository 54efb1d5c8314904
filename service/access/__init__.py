"""Access control: API keys, their tenants, and rate limits."""
