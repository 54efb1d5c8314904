## Entry point and files

parts-unknown-part = Unknown part. Parts of this design: { $parts }.
parts-no-such-file = { $part } has no { $format } file.
parts-input-field = The input of this mechanism is given by `{ $field }`.
parts-rotor-without-shape = a rotor's answer contains masses, radii and angles to correct a rotor with, but no shape of it; use `designs/{"{"}n{"}"}.csv` or `.dxf`, which contain these, to correct the existing rotor
parts-engine-without-widths = an engine's answer contains crank angles, a firing order and balancing masses, but no diameter or width of a bore, journal or web; use `designs/{"{"}n{"}"}.csv` or `.dxf`, which contain these, or request the parts of one cylinder as a slider-crank of `kind` `motion`
parts-not-available = Parts of this type of mechanism are not available: { $reason }.
parts-field-without-meaning = Parts of this type of mechanism have no `{ $field }`; leave it out.

## Sizes

parts-clearance-out-of-range = The clearance must be from { $smallest } to { $largest } { $unit } for pins of { $pin } { $unit }.
parts-thickness-out-of-range = The thickness must be from { $smallest } to { $largest } { $unit } for pins of { $pin } { $unit }.

## Search for sizes that fit

parts-links-narrow-for-pins = Links with pins of { $pin } { $unit } must be at least { $width } { $unit } wide, which leaves a wall of a quarter of the pin.
parts-links-narrow-for-runner = Links with a runner on pins of { $pin } { $unit } must be at least { $width } { $unit } wide, which leaves a wall of a quarter of the pin.
parts-links-narrow-for-blocks = Links with blocks on pins of { $pin } { $unit } must be at least { $width } { $unit } wide, which leaves a wall of a quarter of the pin.
parts-links-narrow-for-shafts = Links with keyed shafts of { $pin } { $unit } must be at least { $width } { $unit } wide, which leaves a wall of a quarter of the pin.
parts-mechanism-too-large = The mechanism is { $size } m large at this scale, but parts are made up to { $largest } m; use at most scale { $scale }.
parts-pin-not-available = Pins of { $pin } { $unit } are not available; use { $smallest } to { $largest } { $unit }.
parts-links-too-wide = Links must be narrower than { $largest } { $unit }, the maximum size of parts.
parts-links-do-not-fit = Links { $width } { $unit } wide do not fit: { $reason }.
parts-only-narrower-fit = Narrower links fit, but these fit at no permitted scale (up to { $scale }).
parts-no-links-fit = Narrower links do not fit either: the mechanism cannot be built in planes.
parts-larger-scale-or-narrower-fits = These sizes fit at scale { $least } or more; at scale { $scale } a width of { $width } { $unit } fits, with pin, thickness and clearance in proportion.
parts-larger-scale-fits = These sizes fit at scale { $least } or more.
parts-walls-too-thin = { $part } has too thin walls around its holes
parts-collide-at-place = { $first } and { $second } collide at the input's place { $place }
parts-collide-at-angle = { $first } and { $second } collide at an input angle of { $angle }°

## Names of links, gears, pins and materials

parts-sheet = sheet
parts-steel = steel
parts-aluminium = aluminium
parts-bronze = bronze
parts-arm = arm
parts-base = base
parts-second-base = second base
parts-cam = cam
parts-carrier = carrier
parts-coupler = coupler
parts-crank = crank
parts-driven-crank = driven crank
parts-follower = follower
parts-idler = idler
parts-input-link = input
parts-link = link
parts-output-link = output
parts-pawl = pawl
parts-pawl-pin = pin pawl
parts-roller-pin = pin roller
parts-planet = planet
parts-long-planet = planet long
parts-short-planet = planet short
parts-post = post
parts-ring = ring
parts-rocker = rocker
parts-roller = roller
parts-sun = sun
parts-large-sun = sun large
parts-small-sun = sun small
parts-upright = upright
parts-wheel = wheel
parts-gear-of-link = gear of { $name }
parts-lower-plate-of-link = lower { $name }
parts-pin = pin { $name }
parts-upper-plate-of-link = upper { $name }
parts-numbered = { $name } { $number }
parts-part-in-sentence = the { $name }

## Pins, keys and distance pieces

parts-pin-cap = cap of { $pin }, pressed or glued on
parts-retaining-ring = retaining ring of { $pin }
parts-washer = washer
parts-spacer = spacer
parts-key = key

## Linkages

parts-teeth-of-wheel = { $teeth } of the { $wheel }
parts-linkage-gear-teeth = Teeth: { $teeth }; module { $module } mm, as the distance of the fixed pivots requires.
parts-linkage-gears-keyed = The gears and their links are keyed to one shaft; their relative angle is the phase of the linkage.
parts-divided-link = Link { $link } consists of two plates, one on either side of the second base. Both are keyed to the shaft { $pivot }, which turns in that base, so that they move as one. Put the lower plate on the shaft before laying that base over it.
parts-input-on-shaft = The input is keyed to the shaft { $pivot }, which is inserted from above and protrudes below the base for the drive.
parts-wheel-with-teeth = { $wheel }, { $teeth } teeth
parts-block = block at { $joint }
parts-shaft-at-joint = shaft { $joint }
parts-ratio-not-exact = No gears with up to { $largest } teeth have the ratio { $ratio } exactly, and an approximate ratio would let the phase of the links drift.
parts-ratio-needs-too-many-teeth = Gears of the ratio { $ratio } need { $first } and { $second } teeth, with at least { $smallest } on the smaller; the maximum is { $largest }.
parts-needs-divided-link = The mechanism cannot be built in planes with shafts on one base, nor between two. Omit `shafts`: then its link { $link } is divided into two plates on one shaft, on either side of the second base.
parts-does-not-assemble = The dimensions of this design do not assemble to a mechanism.
parts-too-many-gear-pairs = Parts are available for linkages with at most one gear pair, which the input must drive.
parts-fits-on-neither-bases = { $one }; with two bases: { $two }
parts-clearance-exceeds-tooth-play = the clearance, also the play of the teeth, exceeds { $share } of their module
parts-not-separated-at-place = no arrangement in planes separates { $first } and { $second } at the input's place { $place }
parts-not-separated-at-angle = no arrangement in planes separates { $first } and { $second } at an input angle of { $angle }°
parts-used-range-impossible = The mechanism cannot move through the used range of this design.
parts-cannot-be-driven = The mechanism cannot be driven: { $reason }.
parts-not-assembled-over-motion = The mechanism cannot be assembled over the whole motion.
parts-input-out-of-range = The input must be from { $low } to { $high }.

## Cams

parts-groove-with-step = The displacement jumps, but a groove cannot have a step.
parts-roller-too-narrow = the roller is not wider than the fastener of its pin
parts-groove-leaves-thin-wall = the groove, as deep as the roller is thick, leaves too thin a wall around the shaft
parts-groove-undercut = the groove's floor is so close to the axis that the roller would cut away its own wall
parts-parts-collide = The parts do not fit: { $first } and { $second } collide.
parts-groove-milling = The groove is milled with a cutter as wide as the roller with its clearance, or printed; the drawing of the barrel is its development, seen from outside.
parts-glue-uprights = Glue or press the feet of the uprights into the base.
parts-runner = runner in the guide
parts-guide-pin = pin guide { $number }
parts-grooved-barrel = barrel with its groove
parts-camshaft = camshaft
parts-cam-with-edge = The cam has an edge where the follower's velocity jumps; such a contour cannot be cut.
parts-cam-bend-too-sharp = The cam has a bend that no smooth curve follows within { $deviation } mm.
parts-fits-neither-above-nor-below = { $above }; with the follower below the cam: { $below }
parts-dowel-pin = pin dowel { $number }
parts-cam-back = back of the cam
parts-groove-inner-wall = cam, inner wall of the groove
parts-groove-outer-wall = outer wall of the groove
parts-grooved-cam = cam with its groove
parts-follower-arms-angle = The angle between the follower's two arms does not permit a one-piece plate.
parts-pivot-pin = pin pivot
parts-camshaft-protrudes = The camshaft protrudes below the base for the drive; all parts that rotate with it are keyed to it.
parts-follower-needs-force = A spring or a weight must hold the follower to the cam; it is not included.

## Geneva drives and ratchets

parts-geneva-with-drag-link = Parts are only available for Geneva drives whose crank is the input; the coupler of this drag link would collide with the shafts on both sides.
parts-slots-do-not-fit = slots with this clearance do not fit into the wheel
parts-locking-disc-too-small = the locking disc reaches { $reach } { $unit } from its axis where the wheel passes it, but the bore for the crankshaft with its key needs { $needed }; use a thinner crankshaft or a larger center distance
parts-geneva-input = The input is the crank; at an input angle of 0 a roller enters a slot.
parts-geneva-keyed = All rotating parts are keyed to their shafts, which protrude beyond the bases.
parts-locking-disc = locking disc
parts-wheel-shaft = wheel shaft
parts-crankshaft = crankshaft
parts-wheel-plate = plate of the wheel
parts-wheel-ring = wheel, a ring
parts-locking-crescent = locking crescent
parts-crescent-pin = pin crescent { $number }
parts-pawl-overlaps-nose = the round end of a pawl about its pivot would overlap its nose
parts-ratchet-wheel = ratchet wheel
parts-ratchet-input = The input is the wheel's angle, counter-clockwise, from the stop of the first pawl.
parts-pawls-need-force = Springs or weights must press the pawls on the teeth; they are not included.
parts-ratchet-keyed = The wheel is keyed to its shaft, which protrudes below the base.
parts-too-few-teeth-for-pawl = The wheel has too few teeth for a one-piece pawl: its nose would collide with the tooth behind.
parts-parts-collide-at-angle = The parts do not fit: { $first } and { $second } collide at an input angle of { $angle }°.
parts-shell-wall-beside-slot = the shell is so thick that the wall between slot and locking hollow is too thin at its inside
parts-shell-wall-between-slots = the shell is so thick that the wall between its slots is too thin at its inside
parts-wheel-shaft-too-thick = the wheel's shaft is thicker than the wheel
parts-hub-between-slots = the hub and shaft of the wheel do not fit between the ends of the slots
parts-cap-around-crankshaft = the locking cap does not fit around the end of the crankshaft
parts-roller-pin-beside-crankshaft = the roller's pin does not fit in the crank next to the crankshaft
parts-hemisphere-wheel = wheel, half a sphere
parts-crank-with-cap = crank with its locking cap
parts-spherical-wheel-dimensions = The wheel is a shell from { $inner } to { $outer } mm in diameter; slots { $width } mm wide, up to { $slot }° above the rim, and hollows of { $hollow }° are milled with tools that point to its centre.
parts-spherical-crank-dimensions = Press or glue the roller's pin into the hole of the crank, { $angle }° from its axis; it points to the centre. The locking cap has { $cap }°, and ends { $offset } mm from the axis.
parts-spherical-wheel-drawing = The drawing of the wheel shows its outside by azimuth and latitude, both times the radius: true to scale along meridians and at the rim.
parts-spherical-input = The input is the crank; at an input angle of 0 the roller enters a slot.
parts-glue-bearing-plates = Glue or wedge the tabs of the bearing plates into the slots of the base.

## Flywheels

parts-flywheel-too-large = The flywheel is about { $size } m large at this scale, but parts are made up to { $largest } m; use at most scale { $scale }.
parts-density-in-si = { $density } kg/m³
parts-density = density { $density }
parts-units-of-mass = units of mass
parts-shaft-not-available = Shafts of { $bore } { $unit } are not available; use { $smallest } to { $largest } { $unit }.
parts-no-hub-within-rim = A bore of { $bore } { $unit } leaves no space for a hub within the rim; use at most { $largest } { $unit }.
parts-no-hub-in-disc = A bore of { $bore } { $unit } leaves no space for a hub in the disc; use at most { $largest } { $unit }.
parts-flywheel = flywheel
parts-flywheel-shaft = flywheel shaft
parts-flywheel-disc-difference = The answer's disc of { $mass } { $unit } is solid: bore and keyway remove { $removed } { $unit } of it and { $share } of its moment of inertia; the shaft and the key that fill them rotate with it.
parts-arms-add-mass = The rim alone has the answer's mass, { $mass } { $unit }, and its moment of inertia; the hub and { $count } arms add { $more } { $unit }, so that the speed varies less than permitted.
parts-plate-adds-mass = The rim alone has the answer's mass, { $mass } { $unit }, and its moment of inertia; the plate within it adds { $more } { $unit }, so that the speed varies less than permitted.

## Gear trains

parts-bevel-face-too-wide = The face width of bevel gears is limited to half the cone distance, { $largest } { $unit }.
parts-gears-cannot-be-cut = The gears cannot be cut: { $reason }.
parts-input-shaft = input shaft
parts-output-shaft = output shaft
parts-bevel-driven = bevel gear, driven, { $teeth } teeth
parts-bevel-driver = bevel gear, driver, { $teeth } teeth
parts-bevel-dimensions = Shaft angle { $angle }°; cone distance { $distance } mm, face width { $width } mm; module { $module } mm at the large end.
parts-bevel-driver-sizes = Driver: { $teeth } teeth, pitch cone { $pitch }°, tip cone { $tip }°, root cone { $root }°, outside diameter { $diameter } mm; mounting distance from the apex to the end of the hub { $distance } mm.
parts-bevel-driven-sizes = Driven gear: { $teeth } teeth, pitch cone { $pitch }°, tip cone { $tip }°, root cone { $root }°, outside diameter { $diameter } mm; mounting distance from the apex to the end of the hub { $distance } mm.
parts-held-by-lower-plate = The { $shaft } is held only by the lower plate.
parts-held-by-upper-plate = The { $shaft } is held only by the upper plate.
parts-key-of-shaft = key of the { $shaft }
parts-feather-key-of-shaft = feather key of the { $shaft }
parts-layshaft = layshaft
parts-main-shaft = main shaft
parts-axle-of-idler = axle of the idler
parts-gear-on-input-shaft = { $pair }, input, { $teeth } teeth
parts-gear-on-layshaft = { $pair }, layshaft, { $teeth } teeth
parts-gear-on-main-shaft = { $pair }, main, { $teeth } teeth
parts-gear-on-idler-axle = { $pair }, idler, { $teeth } teeth
parts-first-gear-direct = Parts are made with the first gear engaged, but the first gear of this gearbox is direct drive.
parts-shafts-obstructed = The shafts do not fit: one of them, or a part on it, would pass through a gear. Try thinner shafts or another scale.
parts-first-gear-engaged = The first gear is engaged: it is keyed to the main shaft; the others turn freely on it.
parts-gearshift-not-included = The mechanism that engages other gears, or couples input and main shaft, is not included.
parts-head-pair = head
parts-reverse-pair = reverse
parts-gear-pair = gear { $number }
parts-shafts-obstructed-in-every-arrangement = The shafts do not fit: in every arrangement one of them, or a part on it, would pass through a gear. Try thinner shafts or another scale.
parts-crossing-shafts-single-stage = Parts of bevel gears and worms are only available for single-stage trains: further stages would need housings at right angles to one another.
parts-web-of-ring = web of the ring
parts-numbered-shaft = shaft { $number }
parts-idler-axle = idler { $number }
parts-wheels-keyed = Wheels are keyed to their shafts; the ends that protrude from the plates are input and output.
parts-ring-driver = ring of stage { $stage }, driver, { $teeth } teeth
parts-gear-driver = gear of stage { $stage }, driver, { $teeth } teeth
parts-ring-driven = ring of stage { $stage }, driven, { $teeth } teeth
parts-gear-driven = gear of stage { $stage }, driven, { $teeth } teeth
parts-gear-idler = gear of stage { $stage }, idler { $number }, { $teeth } teeth
parts-planetary-type-not-available = Parts are only available for planetary trains of spur gears with one carrier.
parts-planetary-shafts-unreachable = The input and the output of this train cannot both be reached from two plates.
parts-web-of-wheel = web of the { $wheel }
parts-shaft-of-member = shaft of the { $member }
parts-axle-of-planet = axle of { $planet }
parts-planetary-gears-keyed = Gears are keyed to their shafts; planets turn on their pins, stepped planets together with them.
parts-member-fixed-by-key = The { $member } is fixed by a key between its shaft and the plate.
parts-member-is-lower-plate = The { $member } is fixed: it is the lower plate.
parts-member-held-by-posts = The { $member } is fixed: it is held by the posts.
parts-input-without-shaft = The { $member } is the input, and has no shaft of its own: connect to its rim.
parts-output-without-shaft = The { $member } is the output, and has no shaft of its own: connect to its rim.
parts-series-with-planetary = Parts are only available for series of ordinary trains; this one has a planetary train, whose shafts end at its carrier and its ring. Request the parts of each train separately.
parts-series-with-reverted = Parts are only available for series of trains that are not reverted: stages in a row have no two coaxial shafts. Request the parts of a reverted train separately.
parts-series-pressure-angles = Parts are only available for trains with one pressure angle.
parts-train-too-large = The train is about { $size } m large at this scale, but parts are made up to { $largest } m; use at most scale { $scale }.
parts-face-width-out-of-range = The face width must be from { $smallest } to { $largest } { $unit } for a module of { $module }.
parts-axle-too-close = The axle of the { $planet } passes the { $gear } at { $distance } { $unit } from its axis, too close for a shaft with a spacer.
parts-root-circle-too-small = The smallest gear has a root circle of { $diameter } { $unit }, too small for a shaft; use scale { $scale } or more.
parts-axle-too-close-at-scale = The axle of the { $planet } passes the { $gear } at { $distance } { $unit } from its axis, too close for a shaft with a spacer; use scale { $scale } or more.
parts-bore-too-large = A bore of { $bore } { $unit } with its keyway leaves too thin a wall below the teeth of the smallest gear, whose root circle is { $diameter } { $unit }; use { $thinner } { $unit }.
parts-bore-too-large-for-any = A bore of { $bore } { $unit } with its keyway leaves too thin a wall below the teeth of the smallest gear, whose root circle is { $diameter } { $unit }.
parts-tooth-play-too-large = The clearance is also the play of the teeth, and must be at most { $largest } { $unit } for the module { $module }.
parts-speed-out-of-range = This gearbox has the speeds 1 to { $count }.
parts-speed-shown = Speed { $number } of { $count } is shown, { $speed } rev/min at the output
parts-shafts-obstructed-in-some-speed = The shafts do not fit: in every arrangement one of them, or a part on it, would pass through a gear in some speed. Try thinner shafts or another scale.
parts-pair-driver = gear of stage { $stage }, pair { $pair }, driver, { $teeth } teeth
parts-pair-driven = gear of stage { $stage }, pair { $pair }, driven, { $teeth } teeth
parts-cluster-hub = hub between the gears of stage { $stage }, pairs { $first } and { $second }
parts-cluster = cluster of stage { $stage }, pairs { $first } and { $second }, drivers, { $lower } and { $upper } teeth
parts-engaged-pair = pair { $pair } of stage { $stage }, { $driver }/{ $driven }
parts-speed-ratio = { $speed }: { $pairs }; input over output { $ratio }.
parts-other-speeds = All speeds have the same parts in different positions: request another speed to see them.
parts-cluster-positions = A cluster of two gears has three positions, { $step } mm from each other along its feather key: lower gear in mesh, neutral, upper gear in mesh. A single sliding gear is in mesh in its lower position and neutral in the upper one. First move every other cluster of the stage to neutral, at rest: turn the shafts until teeth face spaces.
parts-feather-keys-retain = The ends of the feather keys retain the neighbouring parts on the shaft: put on spacers, keys and gears in the order of their positions. Forks, levers and detents that shift the gears are not included.
parts-cluster-bonded = The gears of a two-gear cluster and the hub between them are bonded or screwed together; each gear is keyed, so that the joint transmits no torque. A fork fits between the gears.
parts-cluster-one-piece = A two-gear cluster is one piece with the hub between them, around which a fork fits; its DXF file contains only the outline of the larger gear.
parts-bearing-plate = bearing plate of the { $shaft }
parts-rim-pin = rim { $number }
parts-teeth-collide = Teeth of { $first } and { $second } collide at an input angle of { $angle }° with this play; try a clearance above { $clearance } { $unit }.
parts-worm-shaft = worm shaft
parts-worm =
    { $count ->
        [one] worm, { $count } thread
       *[other] worm, { $count } threads
    }
parts-worm-gear = worm gear, { $teeth } teeth
parts-worm-left-handed = Centre distance of the crossing shafts { $distance } mm; lead angle { $lead }°, left-handed; outside diameters { $worm } and { $gear } mm.
parts-worm-right-handed = Centre distance of the crossing shafts { $distance } mm; lead angle { $lead }°, right-handed; outside diameters { $worm } and { $gear } mm.
parts-worm-gear-cylindrical = The gear is cylindrical, with helical teeth that touch the thread in a point: it transmits the exact ratio, but carries less load than a gear hobbed to the worm.
