# Ranges, intervals and points

model-range-empty = give min, max or both
model-min-above-max = min must not exceed max
model-interval-reversed = the lower end must be below the upper end
model-point-without-coordinate = give at least one coordinate, or leave the point out

# Constraints of linkages

model-min-not-below-max = min must be below max
model-full-rotation-excluded =
    the input of a { $grashof } linkage cannot make a full turn; drop full_rotation or grashof
model-constraint-impossible = { $reason }; drop the constraint
model-manufacture-unsupported = only motion, path and function support `manufacture`, not { $kind }; leave it out
model-rank-by-planes-needs-layout = ranking by planes needs a `layout`
model-rank-by-yield-needs-manufacture = ranking by yield needs `manufacture` with tolerances and a quality
model-space-body-without-positions = only tasks that carry a body through positions have a body
model-body-frame-without-positions = frame body needs a task that carries a body through positions; leave the frame out
model-forces-need-dynamics = forces need `dynamics` with masses, loads and a speed
model-joint-force-index-needs-load = the joint force index needs at least one load in `dynamics`
model-sliding-input-without-torque = a force drives the sliding input, no torque; limit joint_force or power instead

# Sixbars

model-sixbars-skipped = Sixbars were not searched: they do not support { $fields }.
model-stephenson-2-skipped = Stephenson II sixbars were not searched: they do not support { $fields }.
model-stephenson-2-without-class = classifies the fourbar O2 A B O4, which a Stephenson II sixbar does not have
model-sixbars-without-manufacture =
    linkages with more than four links do not support `manufacture`; leave it or these types out
model-sixbars-without-zones =
    these zones are for the sides of a fourbar; for linkages with more links give constraints.{ $name }_region instead

# Targets and input motion of given linkages

model-output-target-fields = a target of the output consists of output and input_angle, without x, y and angle
model-target-incomplete = give x and y of P, or output and input_angle
model-speed-twice = give the speed in rad/s or in revolutions per minute, not both

# Workspace, zones and layout

model-box-corners-swapped = give the lower left corner first, then the upper right corner
model-position-outside-box = position { $position } lies outside the box
model-body-near-obstacle = the body in position { $position } is closer to this obstacle than the clearance
model-outline-without-area = the corners enclose no area
model-outline-intersects-itself = the outline must not intersect itself, as it does at x = { $x }, y = { $y }
model-zone-form = give a polygon or a circle
model-pin-wider-than-link = pin_diameter must not exceed link_width

# Masses, loads and springs

model-materials-need-si = materials are defined in SI units; with consistent units give densities
model-sizes-or-layout = { $reason }; or give a layout, whose sizes are then used
model-speed-missing = give speed_rpm, or speed for a sliding input; 0 means statics
model-prism-needs-sizes = a prism needs width and thickness besides its length
model-cylinder-needs-diameter = a cylinder needs diameter besides its length
model-bore-without-cylinder = only a cylinder has a bore, and its bore must be smaller than its diameter
model-density-or-material = give a density or a material
model-width-and-polygon = give a width or a polygon, not both
model-shape-empty = give a width, a polygon, or parts
model-plate-needs-thickness = a plate, given by a width or a polygon, needs a thickness; parts have their own sizes
model-holes-without-plate = only a plate can have holes; give a width or a polygon
model-square-ends-without-width = only a bar, given by a width, can have square ends
model-overhang-without-square-ends = only square ends can have an overhang
model-mass-and-shape = give the mass properties or a shape, not both
model-mass-or-shape = give a mass, or a shape
model-mass-without-cg = a mass needs its centre of gravity, `cg`
model-rows-not-increasing =
    the first column must increase from row to row; row { $row } does not exceed row { $previous }
model-table-exceeds-period = the rows span { $span }°, more than the { $period }° after which they repeat
model-table-ends-differ = the last row lies one period after the first row and must have equal values
model-load-forms = give one of { $fields }
model-table-fields-without-table = only a table has by, interpolation and turns
model-load-needs-place = a load acts on a link or on a joint; name one of them
model-load-needs-sort = a load is a force or a torque; give one of them
model-torque-on-joint = a torque acts on a link, not on a joint
model-load-point-misplaced = a force on a link needs a point; a torque and a force on a joint have none
model-load-frame-without-point = only a force on a link can rotate with it
model-force-needs-joint = a force of the form { $form } needs a joint
model-spring-form = give the ends of a linear spring, or the torsion rate and the links of a torsion spring
model-spring-fields-mixed = { $fields }: only for the other type of spring
model-torsion-spring-needs-links = a torsion spring needs the two links that it connects, `links`

# Manufacture

model-tolerances-zero = at least one tolerance must be above 0
model-quality-needs-dimension-tolerances = a quality needs tolerances of dimensions: give length or pivot
model-inputs-given-by-task = the task gives the inputs at its targets; use fixed
model-quality-empty = a quality needs max_error or max_angle_error
model-quality-only-angles = the task has only angles; give max_angle_error instead
model-quality-without-angles = the task has no angles; give max_error instead
model-too-many-samples = with { $targets } targets at most { $samples } samples are possible
model-widest-needs-yield = widest needs tolerances of dimensions and quality.yield
model-yield-needs-samples = a yield of { $share } needs at least { $samples } samples
model-yield-needs-tolerances = missing: a yield needs tolerances
model-manufacture-empty = the block is empty; give tolerances, round or stock
model-quality-needs-tolerances = missing: a quality needs tolerances

# Gears: ratios, teeth and stages

model-ratio-zero = a ratio must not be zero
model-ratio-out-of-range = the magnitude of a ratio must be between 1e-9 and 1e9
model-ratio-text-too-long = expected at most { $count } characters
model-ratio-division-by-zero = division by zero
model-ratio-text-ends-early =
    expected numbers, pi, e or sqrt(number) joined by * or /, such as 127/50 or pi/2; got the end
model-ratio-text-unexpected =
    expected numbers, pi, e or sqrt(number) joined by * or /, such as 127/50 or pi/2; got { $text }
model-max-below-min = must not be less than min
model-stage-field-foreign = stages of type { $type } have no such field; leave it out
model-stage-needs-helix-angle = a helical stage needs the helix angle of its driver, other than 0
model-bevel-gears-cannot-mesh = bevel gears with { $driver } and { $driven } teeth cannot mesh at this angle

# Gears: strength

model-lewis-without-contact-stress = Lewis's equation has no contact stress; leave it out or use agma
model-lewis-without-quality = Lewis's equation has no quality number; leave it out or use agma
model-lewis-without-factor = Lewis's equation has no such factor; leave it out or use agma
model-ring-bending-needs-factor = the bending stress of a ring needs factors/{ $name }; give it
model-lewis-only-spur = Lewis's equation is for spur teeth; use agma for helical ones
model-helix-bending-needs-factor = the bending stress of helical teeth needs factors/bending_geometry; give it
model-allowable-stress-missing = give allowable_bending or allowable_contact, in MPa
model-power-carried-by-all-checked = It carries the power by a first estimate; all trains checked do.
model-power-carried-after-failures =
    { $count ->
        [one] It carries the power by a first estimate; { $count } better train does not.
       *[other] It carries the power by a first estimate; { $count } better trains do not.
    }
model-power-carried-by-no-possible =
    None of the { $count } possible trains carries { $power } kW with a face of { $width } modules.
model-power-carried-by-no-best =
    None of the best { $count } trains carries { $power } kW with a face of { $width } modules.
model-strongest-train = The strongest carries { $power } kW by a first estimate.
model-further-trains-unchecked = Further trains were not checked.
model-strength-estimate =
    A first estimate by textbook formulas: life, temperature, lubrication, mounting and material data other than the
    given allowable stresses are ignored. Size gears by the applicable standard.
model-load-sharing-too-large =
    { $planets ->
        [one] with { $planets } planet the factor is at most { $planets }: one planet carries all
       *[other] with { $planets } planets the factor is at most { $planets }: one planet carries all
    }
