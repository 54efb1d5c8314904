# A dimension that no mechanism can have. $name is a field or one of the names below, $expected one of the requirements
# below, $value the value that was given.
kinematics-dimension-required = { $name } must be { $expected }, got { $value }

# Requirements of any dimension, which complete "must be".
kinematics-at-least = at least { $least }
kinematics-count-at-least = a count of at least { $least }
kinematics-positive = positive
kinematics-positive-and-finite = positive and finite
kinematics-sign = +1 or −1
kinematics-zero-or-more = zero or more

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
