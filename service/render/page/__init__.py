"""Building blocks of every drawing: shapes, labels, numbers, blocks of rows. They know no mechanism."""
