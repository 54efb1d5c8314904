"""HTTP conventions that all routes share: bodies, problem details, ETags, authentication, idempotency."""
