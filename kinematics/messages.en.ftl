# A dimension that no mechanism can have. $name is a field or one of the names below, $expected one of the requirements
# below, $value the value that was given.
kinematics-dimension-required = { $name } must be { $expected }, got { $value }

# Requirements of any dimension, which complete "must be".
kinematics-at-least = at least { $least }
kinematics-finite = finite
kinematics-positive = positive

### Cams

# Names of dimensions of cams and followers.
kinematics-base-radius = base radius
kinematics-breaks-and-coefficients = breaks and coefficients
kinematics-cam-speeds = speeds of the cams
kinematics-coefficient-of-fluctuation = coefficient of fluctuation
kinematics-contour-under-flat-face = contour under a flat face
kinematics-cylinder-radius = cylinder radius
kinematics-damping-ratio = damping ratio
kinematics-face-offset = face offset
kinematics-first-knot = first knot
kinematics-flank-radius = flank radius
kinematics-flat-arm-velocity = velocity of a flat face's arm
kinematics-greatest-rate = greatest rate
kinematics-half-action-angle = half action angle
kinematics-law-parts = parts of the law
kinematics-nose-distance = distance of the nose's centre
kinematics-nose-radius = nose radius
kinematics-pivot-distance = pivot distance
kinematics-point-angles = angles of the points
kinematics-prime-or-base-radius = prime or base radius
kinematics-prime-radius = prime radius
kinematics-profile-points = profile points
kinematics-roller-radius = roller radius
kinematics-segment-angle = angle of a segment
kinematics-segment-angles = sum of the segments' angles
kinematics-top-speed = top speed
kinematics-wall-points = wall points

# Requirements of cams and followers, which complete "must be".
kinematics-all-equal = one and the same
kinematics-apart-in-angle = apart in the cam's angle
kinematics-arm-closes-triangle = between { $least } and { $most }, so that arm and pivot distance close the triangle
kinematics-ascending-within-turn = ascending within a turn
kinematics-at-least-rate = at least the least rate { $rate }
kinematics-at-least-speed = at least the speed { $speed }, which is positive
kinematics-between-0-and-pi = between 0 and π
kinematics-breaks-ascend = finite, breaks ascending
kinematics-ccw-or-cw = ccw or cw
kinematics-condition-in-segment = at an angle from 0 to { $angle }, of an order up to { $order }
kinematics-displacement-of-follower = between { $lowest } and { $highest } for this follower
kinematics-distinct-neighbours = finite and different from their neighbours
# The base radius and the face offset together must be less than $most, the pivot distance.
kinematics-face-within-pivot = such that with the base radius it is at least 0 and less than { $most }
kinematics-flank-is-tangent = such that the flank is tangent to base circle and nose
kinematics-given-with-points = given with them
kinematics-less-than-1 = less than 1
kinematics-less-than-cam-velocity = less than the cam's (1 rad/rad)
kinematics-less-than-hollow-radius = less than the hollow's, { $radius }
kinematics-less-than-prime-radius = less than the prime radius { $radius }
kinematics-more-than-roller = more than the roller radius { $radius }
kinematics-no-flanks-in-row = without two flanks in a row, which have no common tangent
kinematics-nose-outside-base = more than { $least }, so that the nose is outside the base circle
kinematics-nowhere-hollow = nowhere hollow
kinematics-one-more-than-rows = one more than the rows of coefficients
kinematics-one-or-more = at least one
kinematics-one-polynomial = such that they determine one polynomial
kinematics-one-turn = one turn (360 degrees)
kinematics-positive-for-normal = positive, since a knife edge determines no normal
kinematics-radius-of-contour = { $radius } for this contour
kinematics-shares-of-half = at least 0, one positive, with a sum of at most 1/2
kinematics-swing-sense = 1 or -1
kinematics-tangent-parts = of parts that are tangent to their neighbours
kinematics-touched-at-every-angle = touched by the follower at every cam angle
kinematics-touched-at-points = touched by the follower at the angles of its points
kinematics-within-radius = at least 0 and less than the radius { $radius }
kinematics-zero-or-at-least = 0 or at least { $least }
