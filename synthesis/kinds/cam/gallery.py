"""Its examples as a person looks for them, in their order."""

from __future__ import annotations

from synthesis.model.kind import Named

GALLERY = (
    Named("Rise and return", "Lift and rest", "The smallest cam that is sound, by modified sine."),
    Named("Gentlest pulse", "Lift and rest", "Up and down with the least acceleration that a bound on jerk allows."),
    Named("Constant feed", "Lift and rest", "Steady speed forth, the gentlest way back."),
    Named(
        "Valve cam",
        "Lift and rest",
        "A flat follower under its spring at 3000 rev/min, with the least force of contact.",
    ),
    Named("Barrel cam", "Lift and rest", "A roller in the groove of a drum, to and fro by 40 mm."),
)
