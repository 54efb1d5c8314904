# Errors of the statement

flywheel-torque-source-choice = give exactly one of torque and machine
flywheel-units-differ = the wheel is given in units { $units }; give the machine in the same units
flywheel-mass-unbounded = unbounded: the mass falls as the radius grows; limit radius, rim_speed or radius_to_thickness, or the minimum thickness (for a rim together with the minimum wall)
flywheel-wall-unbounded = unbounded: a rim gets lighter with a thinner wall; limit the maximum thickness or the wall
flywheel-disc-has-no-wall = a disc has no wall; choose a rim, or omit the limit

# Reasons why a torque is unknown; they follow the colon of torque-unknown

flywheel-motion-not-repeating = the linkage and its loads do not repeat within a few turns
flywheel-forces-unknown = the linkage's forces are not known over the whole cycle: { $status } at { $angle }°
flywheel-torque-not-repeating = the linkage's torque does not repeat after a cycle

# Summaries

flywheel-torque-unknown = No flywheel found: { $reason }.
flywheel-energy = The energy fluctuates by { $energy } over a cycle.
flywheel-mean-torque-negative = The mean torque is negative: on average the other side drives the shaft.
flywheel-not-needed = No flywheel is needed: the shaft keeps the coefficient without one.
flywheel-lightest-wheel = The lightest wheel is a { $form } with a mass of { $mass } and an inertia of { $inertia }. Active limits: { $limits }.
flywheel-form-does-not-fit = No { $form } of the required inertia fits within the limits.

# Progress

flywheel-computing-torque = torque over a cycle
flywheel-sizing = sizing
flywheel-integrating-speed = integrating the speed
