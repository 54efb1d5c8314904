"""Analyses of engines, flywheels, Geneva drives, ratchets, rotors and universal joints."""
