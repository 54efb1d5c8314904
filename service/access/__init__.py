"""Who may ask: keys, the tenants that they stand for, and how often they may ask."""
