"""Models of statements and answers that all kinds share."""
