## PMKS+

simulation-pmks-without-gears = PMKS+ does not support gears.
simulation-pmks-equal-joints = Two links of this design have the same joints; PMKS+ names links by them.
simulation-pmks-too-many-joints = This design has more than { $limit } joints; PMKS+ names joints by single letters.

## Options and motion

simulation-design-dynamics-invalid = The design's `dynamics` is invalid: { $reason }.
simulation-unused-with-sliding-input = This has no meaning for an input that slides; leave it out.
simulation-unused-with-turning-input = This has no meaning for an input that turns; leave it out.
simulation-not-verified-over-motion = This design was not verified over a motion, so there is nothing to simulate.
simulation-input-at-rest = The input of this design does not move in its verified motion.
simulation-speed-too-small = A simulation needs a speed of at least { $least } in size.

## Models

simulation-coordinates-too-large = Coordinates of this design, or their rates, exceed 1e9, the limit for MuJoCo.
simulation-built-larger = Built { $factor } times larger than the design: its bodies would be too light for MuJoCo.
simulation-bodies-too-light = The bodies of this design are too light for MuJoCo: { $lightest } kg or kg m2, less than { $least }.
simulation-does-not-assemble = The dimensions of this design do not assemble to a mechanism.
simulation-cannot-be-driven = This design cannot be driven: { $reason }.
simulation-unused-with-linkage = This has no meaning for a linkage; leave it out.
simulation-redundant-constraints = The constraints of this design are redundant: Modelica's equations would be singular. Use .mjcf with MuJoCo instead.

## Linkages: bodies and masses

simulation-passes-toggle = The design cannot be driven through its whole motion: it contains a toggle.
simulation-block = block at { $joint }
simulation-no-mass = No moving link has mass.
simulation-negligible-masses = Bodies without mass or inertia, given a millionth of the heaviest one's: { $bodies }.
simulation-dynamics-not-in-si = The problem's `dynamics` has its own units, but simulations are in SI units; give it with `units: si`.
simulation-dynamics-field-does-not-fit = The problem's `dynamics` does not fit this design: { $place }: { $reason }.
simulation-dynamics-does-not-fit = The problem's `dynamics` does not fit this design: { $reason }.
simulation-dynamics-not-included = Not included: { $fields } of the problem's dynamics.
simulation-scale-with-masses = The problem's `dynamics` gives the masses of the links: leave out `scale`.
simulation-masses-of-problem = Masses and gravity are those of the problem's dynamics.
simulation-links-as-plates = Links are { $material } plates ({ $density } kg/m3), { $width } m wide with round ends and { $thickness } m thick; their holes are filled by pins.
simulation-gravity-of-problem = Gravity is that of the problem's dynamics.
simulation-no-gravity = There is no gravity.

## Gear trains

simulation-unused-with-gears = This has no meaning for gears; leave it out.
simulation-train-input-fixed = The input of this train is fixed, so there is no motion to simulate.
simulation-gears-as-discs = Gears are { $material } discs ({ $density } kg/m3) of their pitch diameters.
simulation-unused-with-gear-train = This has no meaning for a gear train; leave it out.
simulation-shafts-side-by-side = Non-parallel shafts are placed side by side, as in the drawing.
simulation-gears-do-not-fit = The gears of this train do not fit together, so they have no positions.
simulation-speed-engaged = Speed { $number } of { $count } is engaged.
simulation-gear-engaged = Engaged: { $gear }. The gears that run free on the main shaft count as parts of it.
simulation-gear-out-of-range = This gearbox has the gears 1 to { $count }.
