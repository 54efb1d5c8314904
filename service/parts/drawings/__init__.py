"""Drawings of parts and assemblies: sheets, DXF, isometric and rendered pictures."""
