"""Requests for paths: mechanism types, stance, start."""
