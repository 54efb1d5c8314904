"""The server process: application, connections, precompilation of kernels."""
