"""What every drawing is made of: shapes, labels, numbers, blocks of rows. Knows no mechanism."""
