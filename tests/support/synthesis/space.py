"""Code that several tests share: space."""

LID = {
    "kind": "motion",
    "positions": [
        {"x": 0.0, "y": 0.0, "angle": 0.0},
        {"x": 230.0, "y": 240.0, "angle": 40.0},
        {"x": 190.0, "y": 470.0, "angle": 85.0},
    ],
}
