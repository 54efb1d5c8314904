"""Speed and accuracy, as programs that print a table: ``python -m benchmarks.motion`` and its neighbours."""
