# Errors in the dwells.
dwell-angle-missing = give the length of the dwell by dwell_angle, or use dwells
dwell-angles-fill-turn = { $count } dwells of { $angle }° leave no part of the turn for the movement
dwell-angle-with-dwells = dwells gives the length of each; leave this out
dwell-count-with-dwells = dwells determines their number; leave this out
dwell-dwells-fill-turn = dwells of { $angle }° in total leave no part of the turn for the movement
dwell-places-too-near = less than a tenth of the range from dwell { $dwell }; separate them further
dwell-places-equal = the same place as dwell { $dwell }
dwell-places-within-tolerance = within the tolerance of dwell { $dwell }; make them one dwell
dwell-tolerance-covers-range = not less than the output's range; no dwell would be needed

# Contradictions between mechanism, output and constraints.
dwell-slot-does-not-slide = a slotted output swings; choose pseudo_arc or a rocker
dwell-stephenson-does-not-slide = its output swings; choose pseudo_arc, watt_2 or a rocker
dwell-crank-with-stroke = the stroke determines the size; leave the crank out
dwell-size-lost-in-coordinates = too short relative to the coordinates of the pivot; move the origin nearer
dwell-crank-rockers-only = the crank turns through: only crank-rockers are searched
dwell-turning-cranks-only = the crank turns through: only crank-rockers and double cranks are searched

# Progress; a type is one of the names below.
dwell-driving-random-sixbars = driving random sixbars ({ $type })
dwell-driving-outputs = driving outputs on coupler curves ({ $type })
dwell-refining = refining { $next } of at most { $all }
dwell-verified = verified

# Names of types.
dwell-pseudo-arc = pseudo arc
dwell-straight-slot = straight slot
dwell-watt-2 = watt 2
dwell-stephenson-2 = stephenson 2

# Methods.
dwell-method-from-curves =
    coupler curves drawn at random, outputs on their arcs and lines, sequential linear programming
dwell-method-from-random-sixbars = sixbars drawn at random, sequential linear programming

# Quantities.
dwell-angle = { $angle }°
dwell-angle-and-angle = { $first } and { $last }
dwell-length = { $length } { $unit }

# Summaries.
dwell-sixbars-found =
    { $count ->
        [one] { $count } dwell sixbar
       *[other] { $count } dwell sixbars
    } found. In the first the output moves by at most { $movement } during the dwell, and stays within { $tolerance } over { $angles } of the crank.
dwell-sixbars-found-stillest =
    { $count ->
        [one] { $count } dwell sixbar
       *[other] { $count } dwell sixbars
    } found. In the stillest the output moves by at most { $movement } during the dwell, and stays within { $tolerance } over { $angles } of the crank.
dwell-none-found = No dwell sixbar was found that satisfies all constraints ({ $reasons }). One may still exist.
dwell-none-rests = none comes to rest
dwell-longest-dwells = The longest dwells found are { $angles }.
