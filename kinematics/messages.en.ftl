# A dimension that no mechanism can have. $name is a field or one of the names below, $expected one of the requirements
# below, $value the value that was given.
kinematics-dimension-required = { $name } must be { $expected }, got { $value }

# Names of dimensions.
kinematics-distance-from-slide = distance of { $joint } from its slide
kinematics-gear-ratio = gear ratio
kinematics-greatest-ratio = greatest ratio
kinematics-input-range = range of the input
kinematics-joint-angle = angle of a joint
kinematics-joint-count = number of joints
kinematics-joint-position = position of { $joint }
kinematics-least-ratio = least ratio
kinematics-link-length = length of { $link } from { $first } to { $second }
kinematics-part-link = link of a part
kinematics-part-points = points of a part
kinematics-part-radius = radius of a part
kinematics-plates = plates
kinematics-reference-input = input of the reference
kinematics-slide = slide of { $joint }
kinematics-slide-angle = slide angle of { $joint }
kinematics-stub-shafts = stub shafts

# Requirements of any dimension, which complete "must be".
kinematics-at-least = at least { $least }
kinematics-at-most = at most { $most }
kinematics-between-0-and-1 = between 0 and 1
kinematics-count-at-least = a count of at least { $least }
kinematics-even-and-at-least = even and at least { $least }
kinematics-finite = finite
kinematics-from-0-to-1 = from 0 to 1
kinematics-positive = positive
kinematics-positive-and-finite = positive and finite
kinematics-sign = +1 or −1
kinematics-zero = zero
kinematics-zero-or-more = zero or more
kinematics-zero-or-more-and-finite = positive or zero, and finite

# Requirements of links and their arrangement, which complete "must be".
kinematics-arms-reach-rhombus = one at which the arms reach the rhombus
kinematics-assembly-sign = +1 (open) or −1 (crossed)
kinematics-at-most-long = at most { $most } long
kinematics-away-from-moving-pivots = away from the moving pivots A and B
kinematics-away-from-toggle = away from a toggle
kinematics-bar-and-arm-reach-crank-pin = one at which the bar and the arm reach the crank pin
kinematics-below-right-angle = from 0 to below a right angle
kinematics-count-of-arrays =
    { $count ->
        [one] { $count } array
       *[other] { $count } arrays
    }
kinematics-crank-pin-not-on-pivot = one at which the crank pin is not on O4
kinematics-derivative-order = 0, 1, 2 or 3
kinematics-fewer-among-plates =
    fewer among { $count ->
        [one] { $count } plate
       *[other] { $count } plates
    }
kinematics-finite-points = one or more, finite
kinematics-four-on-last-axis = four on the last axis
kinematics-fourbar-closes = one at which the fourbar can be assembled
kinematics-geared-fivebar-closes = one at which the geared fivebar can be assembled
kinematics-inverted-slider-crank-closes = one at which the inverted slider-crank can be assembled
kinematics-link-of-mechanism = a link of the mechanism
kinematics-links-reach-each-other = one at which the links reach each other
kinematics-longer-than-near = longer than near
kinematics-longest-within-sum = such that the longest is at most the sum of the others
kinematics-moving-link = one that moves
kinematics-ordered-ends = finite, from the lower end to the higher
kinematics-reaches-ram-slide = long enough to reach the ram's slide
kinematics-shorter-than-long-link = shorter than the long link
kinematics-single-design = one design
kinematics-slider-crank-closes = one at which the slider-crank can be assembled
kinematics-turning-link = a link that turns

# Links, slides and gears that do not form a mechanism. Names of links and joints are in quotation marks.
kinematics-gear-pair-with-unknown-link = a gear pair joins { $first } and { $second }, one of which does not exist
kinematics-gear-without-shaft = the gear of { $link } has no shaft: that link is not pinned to the ground
kinematics-gears-need-ratio-and-shafts =
    gears of { $first } and { $second } need a ratio other than 0 and two distinct shafts
kinematics-ground-missing = expected a link named { $link }
kinematics-input-cannot-drive = the input { $input } is neither a link pinned to the ground nor a slide on it
kinematics-joint-listed-twice = link { $link } lists a joint twice
kinematics-joint-on-no-link = the joint { $joint } is on no link
kinematics-joint-without-position = link { $link } lists the joint { $joint }, which has no position
kinematics-link-apart = the link { $link } is not joined to the rest
kinematics-link-needs-two-joints = link { $link } needs at least two joints
kinematics-links-held-by-slides = no pins lead from the input to { $links }; slides alone hold it
kinematics-mobility-above-one = expected a mobility of 1, got { $mobility }; look for a link or joint too many
kinematics-mobility-at-dead-centre =
    expected a mobility of 1, got { $mobility } by the rank of the constraints; where the links are at a dead centre,
    give another position
kinematics-mobility-below-one =
    expected a mobility of 1, got { $mobility }; look for a link or joint too many or, if constraints are meant to be
    redundant, for dimensions that do not agree
kinematics-mobility-by-rank = expected a mobility of 1, got { $mobility } by the rank of the constraints
kinematics-mobility-in-one-position =
    expected a mobility of 1, got 0: the constraints agree in this position, but in no nearby position that the input
    could reach
kinematics-slide-with-unknown-end = a slide joins { $joint } and { $link }, one of which does not exist

# Mechanisms whose motion, circuits or forces cannot be determined.
kinematics-circuits-unknown-if-redundant =
    the constraints are redundant; circuits are known only without redundant constraints
kinematics-friction-undetermined-if-redundant = friction is not determined with redundant constraints
kinematics-gear-ratio-without-period = a gear ratio of { $ratio } does not repeat within { $turns } turns
kinematics-geared-needs-dyads = a geared mechanism must close by dyads from its input; this one does not
kinematics-gears-turn-link-too-often =
    gears turn a link more than { $turns } times before the mechanism repeats; circuits are not known
kinematics-limits-too-close = two limits are too close to be separated; circuits are not known
kinematics-link-always-folded = { $link } is folded flat at every input; circuits are not known
kinematics-link-swings-at-standstill = a link swings freely while the substitute input link stands still
kinematics-link-swings-freely =
    { $link } swings freely at a change point, where its pins coincide, and other links depend on it; circuits are not
    known
kinematics-needs-dyads-and-input-link = expected a mechanism that closes by dyads and is driven by a link
kinematics-no-pair-closes-by-dyads = no pair of links closes this mechanism by dyads
kinematics-redundant-needs-dyads = a mechanism with redundant constraints must close by dyads; this one does not
kinematics-slides-and-gears-need-dyads = a mechanism with slides or gears must close by dyads; this one does not
# Requirements of any dimension, which complete "must be".

# Names of dimensions of gears.
kinematics-addendum-and-dedendum = addendum and dedendum
kinematics-bodies-of-mesh = bodies of a mesh
kinematics-centre-distance = centre distance
kinematics-internal-gear = internal gear
kinematics-module-and-pressure-angle = module and pressure angle
kinematics-teeth-and-normal-module = teeth and normal_module
kinematics-tip-and-root-radius = tip and root radius
kinematics-worm-set = worm set

# Requirements of gears and their stages, which complete "must be".
kinematics-above-0-to-1 = above 0 and at most 1
# $kind: external, internal, helical, bevel or worm
kinematics-absent-in-stage = absent in a stage of kind { $kind }
kinematics-absent-with-idlers = absent in a stage with idlers
kinematics-at-least-one-stage = at least one
kinematics-base-circles-apart = such that the base circles do not overlap
kinematics-below-worm-lock = less than the value at which friction locks the worm
kinematics-between-0-and-half-pi = between 0 and π/2
kinematics-between-0-and-pi = between 0 and π
# $bodies: names, separated by commas
kinematics-body-of-train = one of { $bodies }
kinematics-cones-not-flat = such that both pitch cones are less than flat
kinematics-depth-of-rack-tooth = no deeper than the point of the rack's tooth
kinematics-efficiency-of-meshes = one number, or { $count } for the meshes
kinematics-external-gear = an external gear
kinematics-known-for-every-body = known for every body
kinematics-less-than-right-angle = less than a right angle
# $members: names, separated by commas
kinematics-load-on-member = on one of the members { $members }
kinematics-more-teeth-than-pinion = of more teeth than its pinion
kinematics-pinion-not-larger = positive, with no more pinion teeth than gear teeth
kinematics-positive-numbers = of positive numbers
kinematics-rising-speeds = positive, the highest above the lowest
kinematics-same-on-both-gears = the same on both gears
kinematics-stages-of-gear-pairs = sequences of at least one gear pair
# $gears: names, separated by commas
kinematics-teeth-of-gears = given for exactly { $gears }
kinematics-three-different-bodies = three different ones
kinematics-tooth-bent-by-load = one that its load bends
kinematics-tooth-with-section = one with a section below its load
# Requirements of any dimension, which complete "must be".

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
