"""What requests are answered with that takes the analysis core or a drawing library, and who computes it."""
