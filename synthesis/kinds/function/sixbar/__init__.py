"""Sixbar function generators: residuals, starts, descents."""
