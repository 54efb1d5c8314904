# Motion of the input and size of the answer.
analyses-end-before-start = the end must not lie before the start
analyses-step-too-small = more than { $most } positions; take larger steps
analyses-too-many-positions =
    at most { $most } positions, each of which has { $numbers } numbers here, got { $positions }

# Cams.
analyses-camshaft-needs-plate-cams = a camshaft carries plate cams only; analyse other cams by themselves
analyses-camshaft-needs-speed = the shaft needs a positive speed
analyses-camshaft-turns-steadily = the torques are for a constant speed; leave it out
analyses-neighbouring-points-coincide = neighbouring points must be different
analyses-too-many-points-and-positions = too many points and positions; reduce one of them
analyses-vibration-needs-speed = a vibration needs a positive speed

# Pairs of gears.
analyses-cutter-needs-ring = only a ring is shaped by a cutter; leave it out
analyses-cutter-too-large = a cutter has fewer teeth than the ring that it shapes
analyses-first-gear-without-flank = leaves the first gear no tooth above its base circle
analyses-second-gear-without-flank = leaves the second gear no tooth above its base circle
analyses-module-and-pitch = give either module or diametral_pitch
analyses-pinion-not-first = give the pinion first; the gear has at least as many teeth
analyses-ring-not-second = a ring has more teeth than its pinion; give the ring second
analyses-second-helix-angle-too-large = the second gear would need a helix angle of { $angle }°

# Ordinary gear trains: stages, idlers, friction. $type is a type of stage as the client writes it.
analyses-addendum-needs-ring = only an internal stage can have addenda other than one module
analyses-distance-of-teeth-differs = the teeth have the distance { $distance }; leave it out
analyses-face-reaches-apex = expected less than the cone distance of these gears, { $distance }
analyses-gear-cannot-drive-worm = with this friction the gear cannot drive the worm
analyses-worm-cannot-drive-gear = with this friction the worm cannot drive its gear at any torque
analyses-output-cannot-drive = with this friction a mesh loses all power, so that the output cannot drive
analyses-idlers-exclude-shift = a stage with an idler has no shift
analyses-idlers-need-external-stage = only an external stage has idlers
analyses-ratio-of-teeth-differs = the teeth have the ratio { $ratio }; leave the ratio out
analyses-ring-too-small = a ring has more teeth than its pinion
analyses-stage-unknown = there is no such stage
analyses-stage-without-shift = a stage that is { $type } has no shift
analyses-thread-count-out-of-range = expected 1 to { $most } threads
analyses-too-few-teeth = expected at least { $least } teeth
analyses-worm-has-own-loss = the loss of a worm follows from its own friction; leave it out

# Gearboxes and trains in series.
analyses-forward-gears =
    { $count ->
        [one] there is { $count } forward gear
       *[other] there are { $count } forward gears
    }
analyses-one-gear-of-pair = give both gears, or neither for direct drive
analyses-one-pair-per-stage =
    { $count ->
        [one] expected one pair for the single stage
       *[other] expected one pair for each of { $count } stages
    }
analyses-reverse-gear-missing = there is no reverse gear
analyses-stage-has-fewer-pairs =
    { $count ->
        [one] stage { $number } has { $count } pair
       *[other] stage { $number } has { $count } pairs
    }
analyses-unit-needs-fixed-member = give the fixed member of the unit
analyses-unit-needs-input = give the input of the unit
analyses-unit-needs-output = give the output of the unit
analyses-unit-transmits-no-motion = with these members the train transmits no motion

# Planetary trains. $names lists names of bodies, members, gears or arrangements.
analyses-arrangement-and-meshes = give an arrangement with teeth, or meshes, not both
analyses-arrangement-unknown = expected one of { $names }, or meshes
analyses-drift-needs-input-and-output = give the mechanism's input and output, too
analyses-known-speeds-missing = give known speeds, or the mechanism's input and fixed member
analyses-member-unknown = expected one of the members { $names }
analyses-mesh-of-equal-bodies = its two gears and their carrier must be three different bodies
analyses-name-unknown = expected one of { $names }
analyses-teeth-of-other-gears = expected teeth for { $names }
analyses-speeds-contradict = speeds, torques, powers: the known speed of { $body } contradicts the others
analyses-speeds-open =
    { $count ->
        [one] speeds, torques, powers: { $count } speed is not determined; give another speed, or the fixed member
       *[other] speeds, torques, powers: { $count } speeds are not determined; give more speeds, or the fixed member
    }
analyses-torques-of-clutches-unknown = torques, powers, efficiency: the torque of a clutch does not follow from the speeds
analyses-torques-undetermined =
    torques, powers, efficiency: the given torques do not determine the others; give `torques` and `loads`, or the
    mechanism's `input`, `output` and `fixed`
analyses-efficiency-without-power = efficiency: no power enters the train
analyses-ratio-of-resting-output = ratio, exact_ratio: the output is at rest
analyses-ratio-without-ends = ratio, exact_ratio: give the mechanism's `input` and `output`
analyses-motion-of-given-speeds =
    angle, omega, alpha: only an `input` that turns by `motion` moves the bodies; these speeds are given

# Shift table of a planetary train.
analyses-brake-or-clutch = give either the member that a brake holds or the two members that a clutch connects
analyses-clutch-of-one-member = a clutch must connect two different members
analyses-element-member-unknown = expected members of { $names }
analyses-element-name-repeats = another element has this name
analyses-elements-need-table = ask for the table too: "include": ["shift_table"]
analyses-member-named-input = a member is named input: give it another name, or give the mechanism's input
analyses-output-is-input = { $member } is the input
analyses-table-needs-input = give the mechanism's input, or clutches from the input shaft to members
analyses-table-needs-output = give the mechanism's output for the shift table
analyses-too-many-states = { $count } choices of engaged elements are more than { $most }

# Strength of gears.
analyses-bevel-differential-not-rated = the strength of a bevel differential is not estimated, only that of spur teeth
analyses-face-width-missing = give it, or the allowable stresses from which it is computed
analyses-helical-ring-not-rated = the strength of helical rings is not estimated; leave the helix angle out
analyses-no-power-at-rest = no power is transmitted at rest
analyses-one-face-width-per-plane = expected { $count }, one for each plane
analyses-stage-not-rated = the strength of a stage that is { $type } is not estimated
analyses-strength-excludes-clutches =
    the torque of a clutch is unknown, so that no strength can be computed; leave one out
analyses-strength-excludes-speeds = strength needs the speed of the motion; give input and fixed member instead
analyses-strength-needs-arrangement = give an arrangement; meshes alone do not define the gears
analyses-strength-needs-input = give it; it turns with the speed of the motion
analyses-torque-and-speed-missing = give a torque and a speed; without them no power is transmitted
analyses-unshifted-gears-not-coaxial =
    unshifted gears with these teeth are not coaxial; strength is estimated for unshifted gears only

# Linkages: the mechanism and its drive.
analyses-coupler-point-on-pivot = the coupler point lies on a moving pivot: its curve is a circle
analyses-only-fourbar-has-topics = only a pin-jointed fourbar has { $topics }
analyses-topics = { $topics } and { $topic }
analyses-link-not-moving = there is no moving link of this name; the moving links are { $names }
analyses-shaft-must-drive = a slider drives this mechanism; a shaft must drive it
analyses-slider-speed-as-length = a slider drives this mechanism; give its speed as `speed`, length units per second
analyses-too-many-links-outside-dyads = this mechanism has too many links outside dyads to be solved at once

# Linkages: notes on missing results. They begin with the names of fields, which stay as they are.
analyses-circuits-unknown = circuits, toggles, limits: { $reason }
analyses-too-many-circuits = too many assemblies, or too many turns until the motion repeats, to list all circuits
analyses-limits-at-change-point =
    limits: at a change point the linkage may move on in two ways; the limits are those of the branch of the reference
analyses-limits-unknown = limits: the reference lies where several branches meet, or on none
analyses-motion-followed-in-part =
    valid: the links have very different lengths; the motion was followed up to the maximum number of steps, and
    positions beyond are reported as not valid although they may exist
analyses-output-at-rest = { $field }: null for { $names } where the output is at rest (a dead centre)
analyses-instant-centers-of-one-position =
    instant_centers: listed for a single position only; give it as `motion.at`
analyses-no-pushing-leg =
    transmission_angle: no link is carried by three legs on the input and the ground, so that no leg pushes along a path
    of its own; torque_ratio and force_ratio describe the transmission of force
analyses-no-pushing-link = transmission_angle: gears alone drive every link, so that no link pushes another
analyses-pushing-link-undetermined =
    transmission_angle: constraints are redundant, so that the pushing link is not determined

# Linkages: arrangement in planes.
analyses-layout-not-assembled = the mechanism cannot be assembled over the whole motion
analyses-layout-range-blocked = the mechanism cannot move through the used range
analyses-layout-range-too-long = at most { $most } degrees for a layout, counted from `from`
analyses-layout-stroke-too-long = at most { $most } length units for a layout, counted from `from`

# Linkages: forces. $status and $check are values of fields.
analyses-flywheel-needs-speed = a flywheel needs a speed
analyses-force-check-disagrees = the check { $check } finds a difference of { $difference }
analyses-force-index-high = joint_force_index: { $index }, above { $limit }, at { $position }
analyses-force-index-infinite = joint_force_index: infinite at a dead centre
analyses-status-at-position = { $status } at { $position }

# Linkages: targets and manufacture.
analyses-manufacture-needs-targets = missing: the analysis of manufacture needs targets
analyses-reference-input-missing = missing: needed for the angles of the body; give it, or leave these angles out
analyses-targets-need-fourbar-or-slider-crank =
    only fourbars and slider-cranks given by their dimensions and driven by the crank are supported
analyses-targets-of-different-forms = differs in form from the first target; give all targets in the same form
analyses-tolerances-missing = missing: give the manufacturing accuracy of the linkage
analyses-yield-not-required = only designs can have a required yield; the answer contains the yield

# Machines: engines, flywheels, Geneva drives, ratchets, rotors, universal joints.
analyses-bearings-coincide = two bearings at the same position cannot carry a couple
analyses-center-distance-missing = give it together with the crank's radius
analyses-cone-angle-out-of-range = must be from { $least } to below 90 degrees
analyses-crank-radius-out-of-range = must be from { $least } to below the center distance
analyses-drag-link-cannot-turn =
    the ground must be the shortest link, and ground plus longest link shorter than the other two together
analyses-drag-link-needs-plane-drive = a drag link drives plane Geneva drives only
analyses-first-joint-offset = the first joint has no shaft with forks before it; leave it out
analyses-inner-radius-too-large = must be below the outer radius
analyses-pawl-too-short = must be above half the length of a tooth's face
analyses-rod-too-short = the rod must be longer than the crank's radius
analyses-speed-limit-missing = give the fluctuation, or a minimum or maximum ratio
analyses-tooth-too-high = must be below nine tenths of the wheel's radius
