"""The fourbar in closed form: motion, classification, circuits, cognates, coupler curve."""
