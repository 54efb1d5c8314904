"""Examples of the kind cam for the gallery, in order of presentation."""

from __future__ import annotations

from synthesis.model.kind import NamedExample

GALLERY = (
    NamedExample("Rise and return", "Lift and rest", "The smallest feasible cam with a modified-sine motion."),
    NamedExample(
        "Gentlest pulse", "Lift and rest", "Up and down with the minimum acceleration within a limit on jerk."
    ),
    NamedExample("Constant feed", "Lift and rest", "Constant speed forward, the gentlest return."),
    NamedExample(
        "Valve cam",
        "Lift and rest",
        "A flat follower under its spring at 3000 rev/min, with the minimum contact force.",
    ),
    NamedExample("Barrel cam", "Lift and rest", "A roller in the groove of a drum, back and forth by 40 mm."),
)
