"""Layshaft gearboxes of vehicles: tooth numbers for given gears with one tooth sum."""
