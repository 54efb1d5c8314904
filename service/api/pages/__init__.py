"""Pages of the service for people: the studio, and explanations of errors."""
