### Steering of a vehicle with two stub axles: Ackermann's linkage and Davis's gear.
### Errors are written after the name of a field, without a capital and a full stop.

# Progress of a search.

steering-fitting-ackermann = fitting Ackermann's linkage
steering-verifying = verifying
steering-verified = verified

# Errors in the problem.

steering-track-too-small = the wheels would lie between the kingpins; the track is the larger
steering-arms-too-long = arms of half the pivot distance could meet; give shorter ones
steering-full-rotation =
    a steering mechanism moves from lock to lock and does not turn through; drop this constraint
steering-toggle-between-locks =
    a steering mechanism that passes a toggle between its locks does not steer; leave this true
# The next two are followed by "; drop the constraint".
steering-class-of-davis = Davis's gear has slides and no class of fourbars
steering-class-of-ackermann = Ackermann's linkage, with two equal arms, is never Grashof

# Summary.

steering-best-error =
    { $count ->
        [one] The best of { $count } Ackermann linkage has a steering error of { $error }°.
       *[other] The best of { $count } Ackermann linkages has a steering error of { $error }°.
    }
steering-inside-wheels-first = Linkages whose tie rod keeps inside the wheels are listed first.
steering-davis-is-exact = Davis's gear steers correctly at every angle.
steering-none-exists = No design exists.
steering-none-found = No design was found.
steering-lock-out-of-reach = No Ackermann linkage with such arms reaches the lock.
