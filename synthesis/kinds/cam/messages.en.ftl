### Cams

## Faults of a problem. Each follows the name of a field.

cam-groove-needs-roller = a groove can only guide a roller; choose a roller follower, or closure `force`
cam-pair-needs-rollers = conjugate cams can only guide rollers; choose a roller follower, or closure `force`
cam-barrel-has-walls = a barrel's groove already has two walls; choose a radial roller follower
cam-yoke-has-no-overhang = a yoke around two cams is guided on both sides; omit the overhang
# About the field max of a range with the fields min and max.
cam-max-not-above-min = must be above min
cam-spring-range-too-low = the spring needs a rate of at least { $least }, above the given range
cam-damping-twice = give either `damping` or `damping_ratio`
cam-damping-needs-given-spring = needs a given `spring_rate`; give `damping_ratio` for a spring that is chosen
cam-train-stiffness-missing = a train damping ratio needs `train_stiffness`
cam-max-rpm-below-speed = must be at least `speed_rpm`
cam-walls-need-no-spring = between two walls no spring is needed to hold the follower; give a rate, or choose closure `force`
cam-groove-keeps-contact = in a groove no contact is lost; omit it
cam-spring-and-motion-unknown = force times displacement is not convex if both are unknown; give the spring rate to minimize the contact force, or choose the spring for another criterion or for given laws
cam-contact-force-at-one-speed = motions of minimum contact force are found for one speed only; choose another criterion or omit `max_rpm`
cam-overhang-needs-dynamics = the overhang is the lever of a force; give `dynamics` or omit the overhang
cam-overhang-too-short = must exceed the highest displacement; otherwise the roller runs into the guide
cam-free-offset-needs-dynamics = a free offset minimizes the overturning moment; give `dynamics`, or the offset
cam-moment-needs-slide = only a slide on a radial cam can be overturned; omit the limit
cam-moment-needs-dynamics = a moment depends on the follower's mass and spring; give `dynamics`
cam-moment-needs-overhang = required: the lever of the limited moment
cam-limits-need-free-law = all laws are given, so their peaks cannot change; set a law to auto or optimal, or omit the limit
cam-contact-force-needs-dynamics = a contact force needs the follower's mass and spring
cam-groove-has-no-contact-force = in a groove no force holds the follower; choose another criterion
cam-groove-has-no-least-force = in a groove the roller changes walls and the force its sign; omit `least_force`
cam-forces-need-speed = forces need the cam's speed
cam-least-size-needs-translation = optimal motions of minimum size are found for translating followers only; choose another criterion
cam-least-barrel-by-velocity = a barrel is smallest at the minimum peak velocity, by pressure angle; choose peak_velocity

## Faults of a follower

cam-prime-radius-within-roller = must be larger than the roller
cam-free-offset-needs-free-radius = a free offset needs a free prime radius; omit the prime radius or give the offset
cam-offset-too-large = must be less than the prime radius
cam-free-pivot-needs-free-radius = a free pivot needs a free prime radius; omit the prime radius or give the pivot distance
cam-arm-does-not-reach = arm and pivot distance cannot reach the prime radius
cam-pivot-too-near = must exceed base radius and face offset

## Faults of the segments of a motion program

# $motion is the value rise or fall of a segment's field motion.
cam-lift-missing = a { $motion } needs a lift
cam-return-from-zero = the follower is already at zero; give a lift
# About the fields conditions and bands.
cam-only-for-optimal-motion = only an optimal motion can have them
cam-condition-outside-segment = must lie within the segment's { $angle } degrees
cam-condition-empty = is empty; give s, v, a or j
cam-conditions-dependent = do not determine one polynomial
cam-band-unbounded = has no bound; give lower or upper
cam-band-end-outside = must be after start and within the segment's { $angle } degrees
cam-band-empty = must not be below lower
cam-follower-rests = the follower never moves; add a rise
cam-angles-not-one-turn = the angles add up to { $total } degrees; they must make one turn
# $segment and $following are the numbers of two neighbours; $motion and $following_motion are values of their field
# motion. The last segment is followed by segment 0.
cam-displacement-jumps = displacement jumps by { $jump } where segment { $following } ({ $following_motion }) follows segment { $segment } ({ $motion })
cam-program-does-not-close = displacement jumps by { $jump } where segment { $following } ({ $following_motion }) follows segment { $segment } ({ $motion }); the program must end where it began
cam-joint-breaks-fundamental-law =
    { $derivative ->
        [velocity] velocity
       *[acceleration] acceleration
    } jumps by { $jump } where segment { $following } ({ $following_motion }) follows segment { $segment } ({ $motion }), which breaks the fundamental law of cam design; choose other laws or accept_discontinuity
cam-joint-needs-edge =
    { $derivative ->
        [velocity] velocity
       *[acceleration] acceleration
    } jumps by { $jump } where segment { $following } ({ $following_motion }) follows segment { $segment } ({ $motion }), for which the cam would need an edge that no follower can track; choose laws that join
# $law is a value of a segment's field law.
cam-law-jumps = the acceleration of { $law } jumps; choose another law or set accept_discontinuity
cam-motion-jumps = the motion is not continuous there; see accept_discontinuity

## Progress

cam-composing-program = composing the motion program
cam-optimizing-motion = optimal motion: convex program of { $steps } steps
cam-optimizing-motion-of-several = optimal motion { $number } of { $count }: convex program of { $steps } steps
cam-trading-sizes = trading size by pressure angle against size by curvature
cam-sizing = sizing the cam
cam-verifying = verifying
cam-verifying-with-points = verifying with { $count } points
cam-verified = verified

## Summaries

# $circle is the circle that $radius measures; $unit is a unit of length.
cam-follows-program =
    A cam with a { $circle ->
        [prime] prime radius
        [base] base radius
       *[cylinder] cylinder radius
    } of { $radius } { $unit } follows the program.
# $limit is a field of `limits`.
cam-size-set-by-default = The default `{ $limit }` = { $value } determines the radius; give your own value to change it.
# $checks are names of checks.
cam-fails-checks =
    The smallest cam found, with a { $circle ->
        [prime] prime radius
        [base] base radius
       *[cylinder] cylinder radius
    } of { $radius } { $unit }, fails: { $checks }.
# $criterion is a value of the field minimize.
cam-is-near-minimum =
    Its { $criterion ->
        [size] size
        [peak_velocity] peak velocity
        [peak_acceleration] peak acceleration
        [peak_jerk] peak jerk
        [rms_velocity] rms velocity
        [rms_acceleration] rms acceleration
        [rms_jerk] rms jerk
        [peak_torque] peak torque
        [rms_torque] rms torque
       *[peak_contact_force] peak contact force
    } is within { $gap } % of the minimum.
cam-jerk-unbounded = The acceleration jumps, so the jerk has no finite peak and none is reported.
cam-acceleration-for-instant = Without a limit on jerk an acceleration may be reached only for an instant; set `limits.jerk`.
# $reason is one of the messages below.
cam-none-exists = None exists: { $reason }.
cam-none-found = None found: { $reason }.

## Reasons why there is no cam

cam-no-law-fits = no law fits segment { $segment } within the limits on velocity, acceleration and jerk
cam-no-optimal-motion = no optimal motion was found within the limits and conditions
cam-motion-limits-too-tight = no motion keeps the limits; they must be at least { $factor } times as large
cam-no-size-fits = no cam of any size follows the program within the limits on pressure angle, curvature and face width
cam-no-second-size-fits = the second of the conjugate cams has no size within the limits on pressure angle and curvature
cam-no-cylinder-fits = no cylinder carries the program within the limits on pressure angle and curvature
cam-profile-breaks-off = the profile breaks off at a jump of the displacement or the velocity; choose laws that join
cam-no-contact = the follower cannot be laid against the profile
cam-profile-unresolved = the contact of a roller of radius { $roller } on a cam of prime radius { $radius } is not resolved by the maximum number of points per profile; use a larger roller or a slower motion
cam-groove-unresolved = the contact of a roller of radius { $roller } in a groove on a cylinder of radius { $cylinder } is not resolved by the maximum number of points per wall; use a larger roller or a slower motion

## Scope of the bound on a criterion: the motions for which it holds. $scope is another of these messages.

cam-scope-named-laws = the best of the named laws
cam-scope-given-laws = the laws are given
cam-scope-all-motions = all motions in the optimal segments, with the other segments unchanged
# The ping is the fourth derivative of the displacement.
cam-scope-below-peak =
    { $scope }, with a { $derivative ->
        [acceleration] peak acceleration
        [jerk] peak jerk
       *[ping] peak fourth derivative
    } of at most { $peak }
cam-scope-without-limits = { $scope }, without limits on acceleration and jerk; with them the minimum is higher than the bound
cam-scope-of-size = { $scope }; the bound is by pressure angle, or by curvature and width of a face

## Warnings

# One or several of the next message, joined by the one after it, are the $excesses of the sentence, which is written
# with a capital and a full stop.
cam-peak-high =
    the { $derivative ->
        [velocity] peak velocity
        [acceleration] peak acceleration
       *[jerk] peak jerk
    } is { $times } times
cam-peaks-and-peaks = { $first } and { $second }
cam-peaks-cost = { $excesses } that of a cycloidal motion of the same lift and angle
cam-peaks-need-limits = { $excesses } that of a cycloidal motion of the same lift and angle; set a limit on { $limits }
cam-derivative =
    { $derivative ->
        [velocity] velocity
        [acceleration] acceleration
       *[jerk] jerk
    }
cam-limits-or-limits = { $first } or { $second }
cam-train-too-soft = the natural frequency of the follower train is only { $ratio } times the cam's speed (period over the shortest move's time: { $periods }); the follower will vibrate
cam-train-resonates = a harmonic of the cam's speed coincides with the natural frequency of the follower train: it resonates
