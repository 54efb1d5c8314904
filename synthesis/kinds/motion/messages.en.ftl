### Motion generation. "Positions" are the target poses of the body; a "side" is one dyad of the linkage (input or output).
### Errors are written after the name of a field, without a capital and a full stop.

# Progress of a search.

motion-verified = verified
motion-finding-dyads = finding dyads
motion-finding-sliders = finding sliders
motion-finding-links = finding links
motion-screening-dyad-pairs =
    { $count ->
        [one] screening { $count } pair of dyads
       *[other] screening { $count } pairs of dyads
    }
motion-screening-slider-pairs =
    { $count ->
        [one] screening { $count } pair of links and sliders
       *[other] screening { $count } pairs of links and sliders
    }
motion-verifying-best-pairs =
    { $count ->
        [one] verifying the best of { $count } pair that passed the screening
       *[other] verifying the best of { $count } pairs that passed the screening
    }
motion-sampling-poses = sampling poses within the tolerances
motion-sampling-linkages = sampling linkages in the workspace
motion-fitting-linkages =
    { $count ->
        [one] fitting { $count } linkage to the tolerances
       *[other] fitting { $count } linkages to the tolerances
    }
motion-moving-into-workspace =
    { $count ->
        [one] moving { $count } linkage into the workspace
       *[other] moving { $count } linkages into the workspace
    }
motion-verifying-linkages =
    { $count ->
        [one] verifying { $count } linkage
       *[other] verifying { $count } linkages
    }
motion-fitting-dyads = fitting single dyads
motion-pairing-dyads = pairing dyads
motion-fitting-pair = fitting pair { $number } of { $count }
motion-refining-pair = refining pair { $number } of { $count }
motion-verifying-fits = verifying the fitted linkages
motion-sixbars-examined =
    { $count ->
        [one] { $count } sixbar examined
       *[other] { $count } sixbars examined
    }
motion-eightbars-examined =
    { $count ->
        [one] { $count } eightbar examined
       *[other] { $count } eightbars examined
    }
motion-verifying-best-eightbars =
    { $count ->
        [one] verifying the best of { $count } eightbar
       *[other] verifying the best of { $count } eightbars
    }
motion-verifying-best-sixbars =
    { $count ->
        [one] verifying the best of { $count } sixbar
       *[other] verifying the best of { $count } sixbars
    }

# Errors in the positions and their tolerances.

motion-positions-nearly-equal = are less than { $distance } { $unit } apart; use a smaller unit
motion-position-repeated = equal to position { $position }; positions must differ
motion-tolerance-empty = give a tolerance of x, y or angle; omit it to meet the position exactly
motion-exact-position-with-tolerance = an exact position has no tolerance; give one of the two
motion-method-exact-too-many-positions = at most { $maximum } positions can be exact; use least_squares for more
motion-too-many-exact-positions = at most { $maximum } positions can be exact; give the others a tolerance
motion-too-few-positions-to-fit =
    least_squares needs at least five positions; fewer can be met exactly. Omit it or give tolerances

# Errors in the choices for a side (`input_side`, `output_side`) and the ground line.

motion-rotations-need-exact-positions =
    need positions that are met exactly; omit the tolerances, or set method to exact
motion-link-angle-needs-exact-position =
    needs an exact first position; omit its tolerance, or set method to exact
motion-not-with-fitted-positions = cannot be given if positions are fitted
motion-fitted-vector-incomplete = give both length and angle if positions are fitted
motion-fitted-side-two-pivots = give only one pivot if positions are fitted
motion-fitted-pivot-incomplete = give both coordinates if positions are fitted
motion-slider-pivot-incomplete = give both coordinates of a slider's pivot
motion-slide-angle-without-slider = applies to sliders only; set dyad PR or RP
motion-not-for-dyad = does not apply to a { $dyad } dyad
motion-ground-line-with-slider = cannot be given with a slider
motion-slider-overdetermined =
    { $fixed ->
        [one] fixes { $fixed } number, but { $positions } positions leave a slider only { $free }
       *[other] fixes { $fixed } numbers, but { $positions } positions leave a slider only { $free }
    }
motion-driver-with-slider = applies only to fourbars; omit the slider
motion-driven-block = a block cannot be driven; set RP on the output side
motion-two-sliders = only one side can have a slider; the other needs pins
# Followed by "; drop the constraint".
motion-class-with-slider = applies only to fourbars; a linkage with a slider has no Barker class
motion-rotations-miscounted =
    { $expected ->
        [one] expected { $expected } rotation (one for each later position), got { $given }
       *[other] expected { $expected } rotations (one for each later position), got { $given }
    }
motion-coupler-vector-with-pivot = moving_pivot already fixes the coupler vector; give one of the two
motion-side-overdetermined =
    fixes { $fixed ->
        [one] { $fixed } number
       *[other] { $fixed } numbers
    }, but { $positions } positions leave { $free ->
        [one] { $free } free choice
       *[other] { $free } free choices
    } per side; omit some
motion-side-overdetermined-pivot-possible =
    fixes { $fixed ->
        [one] { $fixed } number
       *[other] { $fixed } numbers
    }, but { $positions } positions leave { $free ->
        [one] { $free } free choice
       *[other] { $free } free choices
    } per side; omit some or give a single pivot
motion-ground-line-overdetermined =
    uses up one more number, but { $positions } positions leave { $free ->
        [one] { $free } free choice
       *[other] { $free } free choices
    } for { $side }, which already fixes { $fixed }
motion-pivot-outside-region = lies outside { $region }
motion-pivot-off-ground-line = does not lie on ground_line
motion-ground-line-parallel = ground_line is parallel to the open coordinate; give the other coordinate
motion-pivots-coincide = equals the input side's { $pivot }; move one of the two

# Errors in `mechanisms` and `chain`.

motion-chain-without-sixbars = applies only to sixbars; list only sixbar types in mechanisms
motion-chain-too-many-positions =
    applies only to at most { $maximum } positions that are met exactly or within tolerances; omit it
motion-chain-type-unsupported =
    applies only to Watt I, Stephenson I and Stephenson III sixbars; request one of these, or omit it
motion-chain-too-short = cannot span G to H₂ at position { $position }: the distance is { $distance } { $unit }
motion-sixbar-too-many-positions = sixbars and eightbars support at most { $maximum } positions; request fourbars for more
motion-not-for-sixbars = applies only to fourbars; omit it, or remove sixbars and eightbars from mechanisms
motion-not-for-stephenson-2 = is not supported for Stephenson II sixbars; omit it, or request other types
motion-slider-not-listed = a side has a slider; add slider_crank to mechanisms
motion-inverted-slider-not-listable = an RP dyad makes an inverted slider-crank, which no list can name; omit mechanisms
motion-fourbar-not-listed = both sides have pins; add fourbar to mechanisms

# Errors in `manufacture`.

motion-manufacture-with-driver = does not support linkages with a driver dyad; omit one of the two
motion-manufacture-type-unsupported = supports only fourbars, and slider-cranks with the slider on the output side
motion-grid-moves-choice = a grid cannot keep { $field } at its given value; omit one of the two
motion-grid-moves-pivots = a grid cannot keep pivots on ground_line; omit one of the two

# Names of a side, which the messages below contain as { $side }.

motion-side = the side
motion-input-side = the input side
motion-output-side = the output side
motion-side-with-pins = the side with pins

# Reasons why a side has no dyads.

motion-straight-translation =
    The positions are a translation along a straight line: every point of the body moves on a line, so only a slider
    can guide it. No pin-jointed fourbar exists.
motion-other-translation =
    The positions are a translation, but not along a circle: every point of the body follows the same points as P, so
    no rigid link can guide it. No pin-jointed fourbar exists.
motion-rotation-about-point =
    All positions are rotations about one point. It would be the fixed pivot of every dyad, so no fourbar exists.
motion-nearly-rotation-about-point =
    All positions are rotations about one point, to the digits given.
motion-no-pinned-dyad = No dyad with two pins satisfies the positions and choices of { $side }.
motion-no-dyad-of-family =
    A family of dyads satisfies the positions and choices of { $side }, but none was found within reach.
motion-no-dyad-in-regions = No dyad of { $side } has its pivots within reach and in the given regions.
motion-no-dyad-found = No dyad found satisfies the choices and regions of { $side }.
motion-other-pivot-far =
    The other pivot of { $side } would lie about { $distance } task sizes away; use a slider instead.
motion-negative-length = Only a link or coupler vector of negative length would meet the choices of { $side }.
motion-rotations-without-link = The rotations of { $side } belong to no link of finite length.
motion-pivot-without-dyad = The given pivot of { $side } belongs to no dyad that meets all positions. { $nearest }
motion-no-nearest-pivot = No pivot within reach does.
motion-nearest-pivot = The nearest pivot that does is at about ({ $x }, { $y }).
motion-pivot-on-line =
    The given pivot of { $side } has all its images on one straight line: only a slider can guide it, not a pin-jointed
    link. No design exists with these choices.
motion-pivot-nearly-on-line =
    The given pivot of { $side } has all its images on one straight line, to within the digits given.
motion-no-body-point-on-line = No point of the body has all its images on one line.
motion-no-fixed-point-on-line = No fixed point has all its images on one line.

# Remarks on the dyads of a side.

motion-dyads-meet-other-positions =
    A dyad that meets { $positions } of the positions meets all { $total }.
motion-dyads-nearly-meet-other-positions =
    A dyad that meets { $positions } of the positions meets, to nine digits, all { $total }.
motion-family-of-dyads = A whole family of dyads satisfies the positions and choices of { $side }.
motion-dyads-coincide = Dyads of { $side } coincide (a double root), or are too close to be counted.
motion-dyads-far =
    { $count ->
        [one] { $count } dyad of { $side } has a pivot more than { $distance } task sizes away.
       *[other] { $count } dyads of { $side } have a pivot more than { $distance } task sizes away.
    }
motion-dyads-uncountable = The positions and choices of { $side } leave too few digits to count the dyads.
motion-dyads-are-sliders =
    { $count ->
        [one] { $count } more dyad of { $side } has a pivot at infinity, that is, a slider ({ $kinds }).
       *[other] { $count } more dyads of { $side } have a pivot at infinity, that is, a slider ({ $kinds }).
    }
motion-two-slider-kinds = { $first } and { $second }

# Parts of summaries.

# Stands for the list of the reasons of rejection if there are none.
motion-none-rejected = none
motion-unproven = This does not prove that none exists.
motion-no-fourbar-exists = All are enumerated, so no fourbar exists.
motion-no-linkage-exists = All are enumerated, so no linkage exists.
motion-best-transmission-angle = Best minimum transmission angle: { $angle }°.
motion-best-error =
    Best root-mean-square residual: { $error } % of the task size (angles in hundredths of a radian).
motion-better-possible = A better linkage may exist.

# Plain guides, before all other sentences of a summary.

motion-hinge-suffices =
    A plain hinge does this: a pin joint at ({ $x }, { $y }) { $unit } carries the body, with P at a radius of
    { $radius } { $unit }, through { $turn }°.
motion-slide-suffices =
    A plain slide does this: a straight guide at { $angle }° through ({ $x }, { $y }) { $unit } carries the body, which
    does not turn, over { $travel } { $unit }.
motion-parallelogram-suffices =
    A parallelogram does this: two parallel cranks of { $length } { $unit } carry the body, each from a pin anywhere on
    the body to a fixed pivot at ({ $x }, { $y }) { $unit } from it in the first position.
motion-guide-misses = It misses the positions by at most { $distance } { $unit } and { $angle }°.

# Summaries of searches for fourbars and slider-cranks.

motion-single-dyad = 1 dyad with two pins gives 0 linkages.
motion-dyads-give-linkages =
    { $dyads } dyads with two pins give { $linkages ->
        [one] { $linkages } linkage
       *[other] { $linkages } linkages
    }; { $accepted } of them { $accepted ->
        [one] carries
       *[other] carry
    } the body through all positions.
motion-driven-from-either-side = Of these, { $count } can be driven from either side.
motion-linkages-with-choices =
    { $accepted } of { $linkages ->
        [one] { $linkages } linkage
       *[other] { $linkages } linkages
    } with the given choices { $accepted ->
        [one] carries
       *[other] carry
    } the body through all positions.
motion-no-pair-feasible =
    No design found: each of the { $candidates } dyad pairs tried violates a constraint (rejected: { $reasons }). The
    search is not exhaustive, so a solution may still exist.
motion-designs-from-pairs =
    { $designs ->
        [one] { $designs } design
       *[other] { $designs } designs
    } verified, chosen from { $feasible } feasible dyad pairs ({ $candidates } tried).
motion-angle-not-reached = No design found reaches { $angle }°.
motion-slider-instead-of-pin = With a slider instead of a pin: { $summary }
motion-sliders-found =
    { $count ->
        [one] { $count } linkage with a slider carries the body through all positions.
       *[other] { $count } linkages with a slider carry the body through all positions.
    }
motion-slider-cranks-verified =
    { $designs ->
        [one] { $designs } distinct slider-crank
       *[other] { $designs } distinct slider-cranks
    } verified, chosen from { $pairs ->
        [one] { $pairs } pair
       *[other] { $pairs } pairs
    } of dyads.
motion-inverted-slider-cranks-verified =
    { $designs ->
        [one] { $designs } distinct inverted slider-crank
       *[other] { $designs } distinct inverted slider-cranks
    } verified, chosen from { $pairs ->
        [one] { $pairs } pair
       *[other] { $pairs } pairs
    } of dyads.
motion-no-slider-crank = No slider-crank found satisfies all constraints (rejected: { $reasons }).
motion-no-inverted-slider-crank = No inverted slider-crank found satisfies all constraints (rejected: { $reasons }).
motion-drivers-added =
    { $accepted } of { $fourbars ->
        [one] { $fourbars } fourbar
       *[other] { $fourbars } fourbars
    } { $accepted ->
        [one] was
       *[other] were
    } given a driver dyad with a fully rotating crank.

# Summaries of fits, with or without tolerances.

motion-no-fit-in-workspace =
    No design found: fits from { $starts ->
        [one] { $starts } start
       *[other] { $starts } starts
    } in the workspace all violate a constraint (rejected: { $reasons }). The search is not exhaustive, so a solution
    may still exist.
motion-fits-in-workspace =
    { $fits ->
        [one] { $fits } design within the workspace uses
       *[other] { $fits } designs within the workspace use
    } the tolerances, and { $exact ->
        [one] { $exact } design meets
       *[other] { $exact } designs meet
    } the positions exactly.
motion-no-fit-within-tolerances =
    No design found: fits from { $starts ->
        [one] { $starts } start
       *[other] { $starts } starts
    } within the tolerances all violate a constraint (rejected: { $reasons }). The search is not exhaustive, so a
    solution may still exist.
motion-fits-within-tolerances =
    { $fits ->
        [one] { $fits } design
       *[other] { $fits } designs
    } from { $starts ->
        [one] { $starts } start
       *[other] { $starts } starts
    } { $fits ->
        [one] uses
       *[other] use
    } the tolerances, and { $exact ->
        [one] { $exact } design meets
       *[other] { $exact } designs meet
    } the positions exactly.
motion-better-pose-possible = The search samples poses within the tolerances, so a better linkage may exist.
motion-no-linkage-for-sampled-poses =
    No linkage for { $sets ->
        [one] { $sets } set
       *[other] { $sets } sets
    } of poses sampled within the tolerances satisfies all constraints. The search is not exhaustive, so a solution may
    still exist. For the exact positions: { $summary }
motion-linkages-for-sampled-poses =
    { $linkages ->
        [one] { $linkages } linkage
       *[other] { $linkages } linkages
    } for { $sets ->
        [one] { $sets } set
       *[other] { $sets } sets
    } of poses sampled within the tolerances { $linkages ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
motion-fits-feasible =
    { $passed } of { $candidates ->
        [one] { $candidates } fitted linkage
       *[other] { $candidates } fitted linkages
    } { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints of the { $positions } positions.
motion-no-fit-feasible =
    { $candidates ->
        [one] None of { $candidates } fitted linkage satisfies all constraints (rejected: { $reasons }).
       *[other] None of { $candidates } fitted linkages satisfies all constraints (rejected: { $reasons }).
    }
motion-closer-possible =
    The fit starts from many points but is not exhaustive, so a closer linkage may exist.

# Summaries of searches for sixbars. The first two are the beginning of a sentence, { $effort } in the next two.

motion-sixbars-fitted =
    { $count ->
        [one] { $count } sixbar was fitted to the positions on one branch
       *[other] { $count } sixbars were fitted to the positions on one branch
    }
motion-eightbars-fitted =
    { $count ->
        [one] { $count } eightbar was fitted to the positions on one branch
       *[other] { $count } eightbars were fitted to the positions on one branch
    }
motion-sixbars-from-chains =
    { $count ->
        [one] { $count } sixbar from chains with two constraining cranks was evaluated
       *[other] { $count } sixbars from chains with two constraining cranks were evaluated
    }
motion-no-sixbar-feasible = { $effort }; no design found satisfies all constraints.
motion-sixbars-verified =
    { $effort }; { $designs ->
        [one] { $designs } design verified.
       *[other] { $designs } distinct designs verified.
    }

# Comparison of fourbars and slider-cranks with sixbars. { $listing } is the rest of the sentence: which of them are
# listed, or the full stop.

motion-only-sixbars-feasible = No fourbar or slider-crank found satisfies all constraints; sixbars do.
motion-no-type-feasible = No fourbar or slider-crank found satisfies all constraints; neither does a sixbar.
motion-only-sixbars-transmit = No fourbar or slider-crank found transmits well enough; sixbars do{ $listing }
motion-sixbars-closer =
    The best fourbar or slider-crank has a root-mean-square residual of { $error } %; sixbars have at most half of
    that{ $listing }
motion-no-sixbar-closer =
    The best fourbar or slider-crank has a root-mean-square residual of { $error } %, and no sixbar found has half of
    that.
motion-sixbars-transmit-better =
    The best fourbar or slider-crank has a minimum transmission angle of { $angle }°; sixbars exceed it{ $listing }
motion-no-sixbar-transmits-better =
    The best fourbar or slider-crank has a minimum transmission angle of { $angle }°, and no sixbar found exceeds it.
motion-only-eightbars-feasible = No linkage with fewer links found satisfies all constraints; eightbars do.
motion-no-eightbar-feasible = No linkage with fewer links found satisfies all constraints; neither does an eightbar.
motion-only-eightbars-transmit =
    No linkage with fewer links found transmits well enough; eightbars do{ $listing }
motion-eightbars-closer =
    The best linkage with fewer links has a root-mean-square residual of { $error } %; eightbars have at most half of
    that{ $listing }
motion-no-eightbar-closer =
    The best linkage with fewer links has a root-mean-square residual of { $error } %, and no eightbar found has half of
    that.
motion-eightbars-transmit-better =
    The best linkage with fewer links has a minimum transmission angle of { $angle }°; eightbars exceed it{ $listing }
motion-no-eightbar-transmits-better =
    The best linkage with fewer links has a minimum transmission angle of { $angle }°, and no eightbar found exceeds it.
motion-only-sixbars-exist = No fourbar or slider-crank solves this; sixbars do.
motion-simple-types-impossible = No fourbar or slider-crank solves this, and no sixbar was found.
motion-only-sixbars-found = No fourbar or slider-crank was found, only sixbars.
motion-no-type-found = No fourbar, slider-crank or sixbar was found.
motion-only-sixbars-of-requested-types = No linkage of the requested types was found except sixbars.
motion-no-requested-type-found = No linkage of the requested types was found.

## Progress

motion-progress-adding-drivers = adding driver dyads
motion-progress-driving-best-pairs = driving the best pairs

# Detail of a check

motion-exact-positions-only = This check covers { $exact } of { $count } positions. The others are fitted: they are missed by at most { $distance } and { $angle }°.
