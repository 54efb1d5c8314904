# Dimensions of given mechanisms

mechanisms-pivots-give-other-distance = the fixed pivots give { $length }; leave the field out or correct it
mechanisms-not-assembled-at-angle = the mechanism cannot be assembled at this input angle
mechanisms-not-assembled-at-any-angle = the mechanism cannot be assembled with these lengths at any input angle
mechanisms-slide-gives-other-offset = the slide and the pivot give { $length }; leave the field out or correct it
mechanisms-coupler-point-undirected = missing: it defines the direction of the coupler point
mechanisms-coupler-point-on-pivot = the crank pin is on O4; the coupler point has no direction
mechanisms-quick-return-crank-length =
    a crank-shaper needs a crank shorter than the ground, a Whitworth mechanism a longer one
mechanisms-fixed-pivots-coincide = both fixed pivots coincide; they must be different

# Skeletons

mechanisms-link-names-equal = the names of the links must be different
mechanisms-skeleton-link-has-other-lengths =
    the skeleton's link { $link } has joints { $lengths } apart; leave the field out or correct it
mechanisms-skeleton-has-other-lengths =
    the skeleton has a link with joints { $lengths } apart; leave the field out or correct it
mechanisms-ground-without-joint = the skeleton's ground has no joint there
mechanisms-skeleton-lacks-joint = the skeleton has no joint { $joint }
mechanisms-skeleton-has-other-point = the skeleton has another P; leave the field out or correct it
mechanisms-angle-with-driving-slide = a slide drives this mechanism; leave the field out
mechanisms-skeleton-has-other-angle = the skeleton's input link has another angle; leave the field out or correct it
mechanisms-skeleton-contradicts-dimensions =
    { $first } and { $second } are { $distance } apart; the dimensions give { $expected }

# Given cams

mechanisms-needed-by-translating-roller = a translating roller needs it
mechanisms-needed-by-oscillating-roller = an oscillating roller needs it
mechanisms-needed-by-oscillating-flat = an oscillating flat needs it
mechanisms-zero-displacement-undefined = needed to define zero displacement
mechanisms-as-many-values-as-x = expected as many values as x
mechanisms-neighbouring-points-equal = neighbouring points must be different
mechanisms-groove-needs-roller = only a roller runs in a groove
mechanisms-flank-radius-or-angle = give either this or the half action angle

# Masses, loads, springs and friction

mechanisms-unknown-moving-link = no link in motion; they are { $links }
mechanisms-unknown-joint = no joint of the mechanism; they are { $joints }
mechanisms-joint-of-other-link = no joint of { $link }
mechanisms-ends-without-bar = only a bar with two joints has ends
mechanisms-friction-with-redundancy = constraints are redundant, so that the forces that cause friction are not unique
mechanisms-friction-without-rotation = nothing turns there; pins are { $pins }
mechanisms-unknown-slide =
    { $count ->
        [one] the mechanism has { $count } slide, counted from 0
       *[other] the mechanism has { $count } slides, counted from 0
    }
mechanisms-index-needs-load = the joint force index needs at least one load
mechanisms-index-with-redundancy = constraints are redundant, so that the joint forces of the index are not unique
mechanisms-flywheel-with-driving-slide = a flywheel needs a driving shaft; a slide drives this mechanism
mechanisms-unknown-link = no link; they are { $links }
mechanisms-spring-on-one-link = a spring acts between two links; both of its ends are on { $link }
mechanisms-torque-with-driving-slider = a slider drives this mechanism; leave the field out
mechanisms-other-slide-drives = the slide that drives is { $slide }
mechanisms-input-link-drives = a torque on the input link drives this mechanism
mechanisms-impossible-inertia = bodies: { $link } has a moment of inertia that no body of its mass and length has
mechanisms-massless-links = bodies: without mass are { $links }
mechanisms-spring-without-direction = both ends coincide in the reference, so that the force has no direction
mechanisms-torsion-spring-not-followed = the rotation of the torsion spring cannot be followed: { $reason }
mechanisms-plate-without-area = the plate has no area; the polygon is flat, or the holes are too wide
mechanisms-hole-beyond-edge = the hole extends beyond the edge of the plate
mechanisms-slide-drives = a slide drives this mechanism
mechanisms-link-drives = the angle of a link drives this mechanism
mechanisms-slide-not-periodic = the position of a slide is not periodic; use linear
mechanisms-slide-does-not-turn = a slide does not turn
mechanisms-table-period-unknown = give the number of turns after which the table repeats: { $reason }
mechanisms-gas-with-driving-slide = gas pressure needs a piston moved by a crank; a slide drives this mechanism
mechanisms-gas-without-full-turn = gas pressure needs a piston moved by a crank; the input cannot make a full turn
mechanisms-gas-without-piston = gas acts on a piston; the joint { $joint } is on no slide of the ground
