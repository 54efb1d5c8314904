# Errors of a rotor

balancing-field-not-for-rotor = not applicable to a rotor; omit it
balancing-unbalance-source-choice = give the unbalance exactly once: by masses, by bearing_readings, or by influence
balancing-reading-speed-missing = bearing forces determine an unbalance only at a known speed; give it
balancing-grade-needs-field = the balance grade needs it: e ω = U/m ω
balancing-couple-needs-bearings = unbalances off the single plane make a couple, which counts at the bearings; give them
balancing-planes-too-close = the two planes are too close; for a single plane give one place
balancing-bearings-too-close = the two bearings are too close
balancing-trial-run-count =
    { $count ->
        [one] expected { $count } run with a trial weight, one per plane
       *[other] expected { $count } runs with a trial weight, one per plane
    }
balancing-reading-count-differs =
    { $count ->
        [one] the initial run has { $count } reading
       *[other] the initial run has { $count } readings
    }
balancing-reading-count-too-small =
    { $count ->
        [one] expected at least { $count } reading, one per plane
       *[other] expected at least { $count } readings, one per plane
    }
balancing-planes-indistinguishable = the trial weights change the readings equally or not at all; the planes cannot be distinguished
balancing-hole-step-count = max_per_hole must be 1 to { $count } steps
balancing-correction-choice = give exactly one of radius, mass, holes and stock
balancing-stock-is-added = weights in stock are added

# Errors of a linkage

balancing-field-not-for-linkage = not applicable to a linkage; omit it
balancing-linkage-field-required = required to balance a linkage
balancing-linkage-at-rest = a linkage at rest does not shake; give a speed
balancing-field-not-for-goal = not applicable to the goal { $goal }; omit it
balancing-mass-unbounded = unbounded: more mass always shakes less; limit the mass of each weight, or of all
balancing-friction-not-supported = the best weights can only be computed without friction; omit it
balancing-objective-empty = the objective is empty: give shaking_force, shaking_moment, drive or joint_forces a weight
balancing-radius-and-mass-given = give the radius or the mass; the other follows
balancing-disc-size-incomplete = a disc has a density and a thickness; give both or neither
balancing-disc-size-missing = a disc needs a density and a thickness; give both
balancing-link-named-twice = name each link once
balancing-masses-missing = without mass nothing shakes; give the masses of the links
balancing-not-a-moving-link = not a moving link; these are { $links }
balancing-not-a-joint-of-two-links = not a joint of two links; these are { $joints }

# Reasons why gears cannot balance the moment; they follow the colon of no-moment-balance-known

balancing-mass-off-crank-pins = there is a mass at { $joint }; only the pins of the cranks may carry one
balancing-geared-inertias-for-fourbars = geared inertias are known for pin-jointed fourbars only
balancing-coupler-center-off-pin-line = the coupler's centre of gravity is off the line of its pins
balancing-coupler-disc-too-flat = a disc in the middle of the coupler is too flat; make it thicker or denser

# Summaries

balancing-none-found = No design found.
balancing-none-exists = No design exists.
balancing-mechanism-not-assembled = The mechanism cannot be assembled over this motion.
balancing-balanced-already = The linkage is already balanced.
balancing-force-balanced = Counterweights on { $links } cancel the shaking force.
balancing-moment-changed = The shaking moment is { $ratio } times the unbalanced one.
balancing-weights-on-other-links = No weights of this size on { $links } balance the force; weights on other links do.
balancing-links-without-pins =
    { $count ->
        [one] None exists: a linkage can be balanced if every link reaches the ground by a path of pins, and { $links } has none.
       *[other] None exists: a linkage can be balanced if every link reaches the ground by a path of pins, and { $links } have none.
    }
balancing-no-weights-balance-force = None exists: no weights on the moving links balance the force.
balancing-moment-balanced = Neither a force nor a moment shakes the frame: the coupler acts like two masses at its pins, and gears turn an equal inertia against each crank.
balancing-no-moment-balance-known = No such balance is known: { $reason }.

# Summaries of the goal minimize

balancing-objective-reduced = The objective is reduced to { $value }; no counterweights reduce it below { $bound }.
balancing-objective-zero-already = The { $quantity } is zero without counterweights; omit it.
balancing-joint-force = joint { $joint }
balancing-joint-forces-undetermined = Joint forces that redundant constraints leave undetermined cannot be minimized or capped; omit them.
balancing-caps-not-met = None exists: the caps cannot be met together. Raised by { $share } % they could; { $caps } would then be reached.
balancing-program-not-solved = No design found: the program was not solved.

# Summaries of rotors

balancing-rotor-balanced =
    { $planes ->
        [one] Balanced in one plane. The shaking force is balanced; moments out of the plane remain.
       *[other] Balanced in two planes.
    }
balancing-rotor-balanced-by-places =
    { $planes ->
        [one] Balanced in one plane by { $places } masses or holes; residual unbalance { $residual }.
       *[other] Balanced in two planes by { $places } masses or holes; residual unbalance { $residual }.
    }
balancing-smallest-residual = The smallest residual found is { $residual }, not proven to be the best.
balancing-smallest-residual-proven = The smallest residual found is { $residual }, proven for this number of places.
balancing-smallest-residual-grade-exceeded = The smallest residual found is { $residual }, not proven to be the best; its grade exceeds the limit.
balancing-smallest-residual-proven-grade-exceeded = The smallest residual found is { $residual }, proven for this number of places; its grade exceeds the limit.
balancing-smallest-grade = The smallest grade found is { $grade } mm/s.

# Progress

balancing-choosing-masses = choosing masses
balancing-finding-links = finding sets of links
balancing-measuring-linkage = measuring the linkage
balancing-solving-programs = solving the conic programs
