### Parallel motion: a sixbar carries a body along a coupler curve without turning it.
### Errors are written after the name of a field, without a capital and a full stop.

# Progress of a search, and its method.

parallel_motion-verified = verified
parallel_motion-method = cognates, one of them moved to the other's pivot

# Errors in the problem.

parallel_motion-no-cognates =
    only a fourbar has the cognates that guide the body; for another mechanism give the path of its point
parallel_motion-linkage-or-path = give either a linkage or a path
parallel_motion-belongs-to-sixbar = the sixbar is built, not the fourbar; give this next to the path
parallel_motion-pivots-coincide = equal to the input's pivot; the ground link has no length
parallel_motion-link-too-long = one link is at least as long as the others together
parallel_motion-ground-disagrees = the fixed pivots give { $length }; leave the field out or correct it
parallel_motion-links-too-short = too short relative to the coordinates of the pivots; move the origin nearer
parallel_motion-point-on-pin =
    on a pin of the coupler P runs on a circle and has no cognate; a parallelogram carries a body there
parallel_motion-input-angle-impossible =
    the linkage cannot be assembled at this input angle; leave it out or correct it
parallel_motion-skeleton-of-other-type =
    not that of a fourbar with the links O2–O4, O2–A, A–B–P and O4–B; leave it out
parallel_motion-joint-disagrees = the dimensions put { $joint } at ({ $x }, { $y }); leave the skeleton out

# Summary.

# Stands for the list of the reasons of rejection if there is no candidate.
parallel_motion-no-fourbar = no fourbar
parallel_motion-none-carries =
    { $candidates ->
        [one] None of { $candidates } sixbar carries the body along the curve ({ $reasons }).
       *[other] None of { $candidates } sixbars carries the body along the curve ({ $reasons }).
    }
parallel_motion-sixbars-carry =
    { $passed } of { $candidates ->
        [one] { $candidates } sixbar
       *[other] { $candidates } sixbars
    } { $passed ->
        [one] carries
       *[other] carry
    } the body along the curve without turning it.
parallel_motion-best-design =
    Best design: minimum transmission angle { $angle }°, driven at Q = ({ $x }, { $y }) relative to P.
parallel_motion-best-design-swings =
    Best design: minimum transmission angle { $angle }° (driven back and forth along a part of the curve), driven at
    Q = ({ $x }, { $y }) relative to P.

## Progress

parallel_motion-progress-driving-sixbars = driving sixbars
