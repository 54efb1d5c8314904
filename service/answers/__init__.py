"""Answers to requests that need the analysis core or a drawing library, and the processes that compute them."""
