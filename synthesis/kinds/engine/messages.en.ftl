# Errors of the statement

engine-rod-choice = give exactly one of rod and rod_ratio
engine-rod-too-short = the rod must be longer than the crank's radius
engine-rod-too-long = the rod is more than { $ratio } times as long as the crank's radius
engine-rod-center-beyond-pin = lies beyond the wrist pin
engine-speed-missing = forces of masses and gas need a speed
engine-bore-missing = gas pressure acts on the bore; give `bore`
engine-flywheel-without-torque = a flywheel evens the torque; give masses or pressure

# Errors of the layout, its throws and its firing

engine-vee-angle-choice = a vee or w needs the angle between its banks; other layouts have none
engine-pins-of-one-bank = only layouts with several banks can have pins of their own
engine-banks-not-filled = { $cylinders } cylinders do not fill { $banks } banks; use pins `own`
engine-throw-list-length = expected { $count }, one for each throw
engine-throws-of-further-layouts = throws of further layouts are found; omit them
engine-firing-order-incomplete = expected each of the cylinders 1 to { $count } once
engine-firing-angle-count = expected an angle for each cylinder of firing_order
engine-nothing-to-find = the throws are given, so nothing is to be found; omit this
engine-too-many-combinations = { $combinations } combinations of { $count } throws for { $layout } are too many to compare

# Summaries

engine-none-passed = No engine passed its checks.
engine-fires-evenly = The { $layout } engine fires evenly in the order { $order }.
engine-fires-unevenly = The { $layout } engine fires unevenly (intervals differ by { $difference }°) in the order { $order }.
engine-unbalanced = Unbalanced after crankshaft counterweights: { $parts }.
engine-balanced = Unbalanced after crankshaft counterweights: nothing up to the second order.
engine-none-fires-evenly = No arrangement of these throws fires evenly; give throw_angles to compare uneven ones.
engine-arrangements = Arrangements of the throws: { $count }.
engine-arrangements-compared = Arrangements of the throws: { $count }, of which { $compared } symmetric ones were compared.
engine-even-arrangements = Arrangements of the throws with even firing: { $count }.
engine-even-arrangements-compared = Arrangements of the throws with even firing: { $count }, of which { $compared } symmetric ones were compared.

# Progress

engine-analysing = analysing
engine-arranging-throws = arranging the throws of layout { $number }
engine-analysing-best = analysing the best
