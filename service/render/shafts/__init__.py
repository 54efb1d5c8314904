"""Drawings of what turns with a shaft: flywheels."""
