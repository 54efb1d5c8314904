"""Programs that generate files of the studio from the answers of a running service, and collect its texts and types."""
