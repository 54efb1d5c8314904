"""Code that several tests share: space."""

TURNS = {
    "kind": "function",
    "pairs": [
        {"input": x, "output": y} for x, y in ((0.0, 0.0), (20.0, 9.0), (40.0, 20.0), (60.0, 34.0), (80.0, 50.0))
    ],
    "zeros": None,
    "max_designs": 3,
}
