"""Assemblies: items, plates, fasteners, bill of materials, interference."""
