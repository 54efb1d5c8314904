# Errors in the points and their timing.
path-angle-with-free-timing = timing is free; set "timing": "prescribed", or leave this out
path-prescribed-timing-only = applies to prescribed timing only; the timing is free
path-angle-missing = timing is prescribed; give an angle
path-too-few-angles = prescribed timing needs at least three different crank angles
path-angles-repeat = equal to that of point { $point }; exact points need different angles
path-angles-out-of-order =
    the crank angles do not follow one another within one turn; reorder the points, or set "in_order": false
path-too-few-points-differ =
    { $count ->
        [one] all of them are equal; at least three must differ
       *[other] only { $count } of them differ; at least three must differ
    }
path-points-all-equal = all equal; points must differ
path-points-repeat = equal to point { $point }; points must differ
path-tolerance-missing = missing, though other points have one; give it for all points, or for none
path-exact-points-with-tolerances =
    points that are met exactly have none; fit them by least_squares, or leave the tolerances out

# Contradictions between method, timing and constraints.
path-too-many-points = at most { $count } points can be met exactly with free timing here; fit them by least_squares
path-too-many-points-with-timing =
    at most { $count } points can be met exactly with prescribed timing here; fit them by least_squares
path-free-place-for-matched-fourbars = applies to curve_match by fourbars only; leave it out
path-matched-curve-with-timing = a curve matched as a whole has no timing; leave it free
path-fixed-pivots-equal = the fixed pivots must differ
path-pivot-outside-region = outside the region that it must lie in
path-class-does-not-turn = the input of a { $grashof } linkage does not turn through; a closed curve needs it
path-manufacture-not-for-fivebars = supports fourbars and slider-cranks, not geared fivebars
path-manufacture-not-for-free-place = does not support curves with a free place; leave placement_free out

# Requests that a type of mechanism does not support. Types are named by the client's values, such as slider_crank.
path-mechanism-without-gears = a { $mechanism } has no gears
path-output-does-not-turn = with an output that does not turn it is a fourbar; request that
path-gears-do-not-repeat = the gears do not repeat within { $turns } turns; give a ratio of small whole numbers
path-timing-for-fourbars-only = only fourbars support prescribed timing; free it for a { $mechanism }
path-mechanism-without-class = classifies fourbars; a { $mechanism } has no class
path-coupler-point-for-fourbars-only = limits the place of P on a fourbar's coupler; leave it out for a { $mechanism }
path-slider-crank-with-output-pivot = a slider-crank has one fixed pivot, the crank's
path-types-named-twice = mechanisms already names all types; leave this out
path-types-without-gears = none of the requested mechanisms has gears
path-not-for-sixbars = does not apply to sixbars and eightbars; leave it out, or remove these types from mechanisms
path-turning-sixbars-only = only sixbars and eightbars whose crank turns through are searched
path-stance-not-for-stephenson = is not supported for Stephenson II sixbars; name others, or leave it out

# Errors in a stance.
path-stance-point-unknown = there are { $count } points, counted from 0
path-stance-of-one-point = a stance needs two different points
path-stance-wraps-around = an open path does not continue past its last point; exchange them
path-stance-points-coincide = the two points coincide and define no line
path-stance-without-limits = constrains nothing; give its flatness, or a constant speed
path-stance-speed-is-free = applies to a constant speed; set "speed": "constant"
path-stance-on-exact-points = exact points leave no freedom for a stance; fit them
path-stance-with-timing = a stance needs free timing; it defines how P moves with the input
path-stance-with-free-place = a stance lies where it is drawn; leave this out
path-stance-out-of-order = a stance visits its points in order

# Errors in a start: a fourbar from which a fit begins.
path-start-for-least-squares-only = a start is for least_squares only; choose that method
path-start-with-timing = a start is for points of free timing
path-start-is-no-fourbar = a start must be a fourbar
path-start-with-stance = a start is for fits of points alone; leave one of the two out
path-start-link-without-length = a link has no length; its two joints must differ

# Progress.
path-verified = verified
path-linkages-verified = { $done } of { $all } linkages verified
path-linkages-driven = { $done } of { $all } linkages driven
path-real-linkages-verified = { $done } of { $all } real linkages verified
path-linkages-perturbed = { $number } linkages perturbed and fitted again
path-eightbars-driven = { $done } of { $all } eightbars driven
path-sixbars-driven = { $done } of { $all } sixbars driven
path-driving-linkages = driving linkage { $next } of { $all }
path-following-paths = { $count } paths
path-paths-followed = { $done } of { $count } paths followed
path-round = round { $round } of { $rounds }: { $progress }
path-round-found =
    { $count ->
        [one] round { $round } of { $rounds }: { $count } linkage meets all points
       *[other] round { $round } of { $rounds }: { $count } linkages meet all points
    }
path-computing-dyads = computing all dyads
path-linkages-compared = { $done } of { $count } linkages compared
path-best-shapes-refined = best shapes refined
path-fitting-with-angle = fitting with a transmission angle of { $angle }°
path-fitting-stance = fitting the stance
path-refining-fits = refining fits
path-fitting-class = class { $number } of { $count }: fitting from random starts
path-perturbing-fits = perturbing the best fits
path-shapes-compared = shapes of linkages compared
path-linkages-fitted =
    { $count ->
        [one] { $count } linkage fitted
       *[other] { $count } linkages fitted
    }
path-eightbars-fitted = Round { $round }: { $compared } eightbars compared, { $fitted } fitted
path-sixbars-fitted = Round { $round }: { $compared } sixbars compared, { $fitted } fitted

# Summaries of exact searches.
path-five-points-with-timing =
    { $inputs ->
        [one] { $inputs } input dyad
       *[other] { $inputs } input dyads
    } and { $fourbars ->
        [one] { $fourbars } fourbar
       *[other] { $fourbars } fourbars
    } pass the five points at their crank angles; { $passed ->
        [one] { $passed } of them satisfies
       *[other] { $passed } of them satisfy
    } all constraints.
path-dyads-with-slider =
    { $count ->
        [one] { $count } more dyad has
       *[other] { $count } more dyads have
    } a pivot at infinity (a slider).
path-family-with-timing =
    { $passed } of { $count ->
        [one] { $count } linkage
       *[other] { $count } linkages
    } through the { $points } points at their crank angles { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
    The points leave freedom; the linkages are random samples of it.
path-family-fitted =
    { $starts ->
        [one] { $starts } start near a curve through the points was
       *[other] { $starts } starts near a curve through the points were
    } fitted; { $reached } reached all points exactly, with the required pivots.
path-distinct-linkages-passed =
    { $passed } of { $count } distinct linkages { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-solutions-on-pivots =
    { $computed } of { $count } solutions on these pivots were computed; { $real ->
        [one] { $real } is real
       *[other] { $real } are real
    },
    { $on_one_circuit ->
        [one] { $on_one_circuit } of these has
       *[other] { $on_one_circuit } of these have
    } all points on one circuit, and { $passed ->
        [one] { $passed } satisfies
       *[other] { $passed } satisfy
    } all constraints.
path-triples-computed =
    { $computed } of { $count } triples of cognate fourbars were computed; { $real ->
        [one] { $real } is real
       *[other] { $real } are real
    },
    { $on_one_circuit ->
        [one] { $on_one_circuit } of these has
       *[other] { $on_one_circuit } of these have
    } all points on one circuit, and { $passed } of { $designs ->
        [one] { $designs } design
       *[other] { $designs } designs
    } { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-others-may-exist = Others may exist.
path-no-fourbar-does-both = These are all fourbars, so none of them does both.
path-no-design-exists = These are all fourbars, so no design exists.
path-none-found = None was found; some may still exist.
path-none-exact-so-fitted =
    No { $type } meets the points exactly and satisfies all constraints; the points are fitted instead. { $fits } Exact
    search: { $exact }
path-none-exact-found-so-fitted =
    No { $type } was found that meets the points exactly and satisfies all constraints; the points are fitted instead.
    { $fits } Exact search: { $exact }
path-fits-miss-points =
    The best least-squares fit misses a point by { $miss } { $unit }, more than { $share }% of the task's size; choose
    method least_squares to get such designs.

# Summaries of fits to points.
path-fits-passed =
    { $passed } of { $count ->
        [one] { $count } fitted linkage
       *[other] { $count } fitted linkages
    } { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-best-fit-with-timing =
    The best passes the { $points } points at their crank angles with a root-mean-square distance of { $rms_distance }
    { $unit } and a maximum of { $max_distance } { $unit } (sum of squares { $sum_of_squares } { $unit }²).
path-best-fit-in-order =
    The best passes the { $points } points in order with a root-mean-square distance of { $rms_distance } { $unit } and
    a maximum of { $max_distance } { $unit } (sum of squares { $sum_of_squares } { $unit }²).
path-curve-strays = Between the given points the curve strays by up to { $excursion } { $unit }.
path-fits-far-between-points =
    { $count ->
        [one] { $count } other is
       *[other] { $count } others are
    } near the points, but far from their course between them.
path-no-fit-passed =
    None of { $count ->
        [one] { $count } fitted linkage
       *[other] { $count } fitted linkages
    } satisfies all constraints (rejected: { $reasons }).
path-no-fits = No linkage could be fitted to the points.
path-descended-from-given-start = Least squares descended from the given start; a nearer linkage may exist elsewhere.
path-descended-from-many-starts =
    Least squares descended from many starts; a nearer linkage may exist that none of them reaches.

# Summaries of whole curves and of stances.
path-curve-fitted-on-pivots = Linkages on the given pivots were fitted to points along the curve from many starts.
path-some-passed =
    { $passed } of { $count } { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-curves-compared =
    { $curves } curves of { $linkages ->
        [one] { $linkages } linkage
       *[other] { $linkages } linkages
    } were compared with the target and { $refined } of them refined.
path-designs-and-cognates-passed =
    { $passed } of { $count } designs, cognates included, { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-best-curve =
    The best draws the curve with an rms distance of { $rms_distance } { $unit } and a maximum distance of
    { $max_distance }.
path-cognates-ranked =
    Cognates draw the same curve; the one with pivots near the curve, good force transmission and even links comes
    first.
path-flattest-stance = The flattest stance lies within a band of { $flatness } { $unit }.
path-flattest-and-most-even-stance =
    The flattest stance lies within a band of { $flatness } { $unit }; the most even speed stays within { $deviation } %
    of its mean.

# Summaries of other types. A type is one of the names below, or several of them joined by path-type-or-type.
path-slider-cranks-passed =
    { $passed } of { $count ->
        [one] { $count } slider-crank that was
       *[other] { $count } slider-cranks that were
    } fitted { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-geared-fivebars-passed =
    { $passed } of { $count ->
        [one] { $count } geared fivebar that was
       *[other] { $count } geared fivebars that were
    } fitted { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-sixbars-passed =
    { $passed } of { $count ->
        [one] { $count } sixbar that was
       *[other] { $count } sixbars that were
    } fitted { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-eightbars-passed =
    { $passed } of { $count ->
        [one] { $count } eightbar that was
       *[other] { $count } eightbars that were
    } fitted { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
path-no-linkage-fitted = No linkage that was drawn could be fitted within the constraints.
path-best-distance = The best one's rms distance is { $rms_distance } { $unit }.
path-best-sixbar-exact = The best sixbar is a { $type } with P on { $link }, which meets the points.
path-best-sixbar = The best sixbar is a { $type } with P on { $link }; its rms distance is { $rms_distance } { $unit }.
path-best-sixbar-both-ways =
    The best sixbar is a { $type } with P on { $link }; its rms distance is { $rms_distance } { $unit },
    { $both_way_rms } both ways.
path-best-eightbar-exact = The best eightbar, with P on { $link }, meets the points.
path-best-eightbar = The best eightbar has P on { $link }; its rms distance is { $rms_distance } { $unit }.
path-best-eightbar-both-ways =
    The best eightbar has P on { $link }; its rms distance is { $rms_distance } { $unit }, { $both_way_rms } both ways.
path-only-other-passed = No { $simple } was found that satisfies all constraints; { $other }s do.
path-neither-passed = No { $simple } or { $other } was found that satisfies all constraints.

# Without a full stop: a remark on the listed designs follows, as in "; they are not listed ...".
path-only-other-sound = No { $simple } that was found is sound; sound { $other }s were found
path-other-halves-error = The error of the best { $simple } is { $error } { $unit }; { $other }s have at most half of it

# Comparisons of types that end the summary.
path-neither-sound = No { $simple } that was found is sound, and no { $other } is.
path-no-other-halves-error =
    The error of the best { $simple } is { $error } { $unit }, and no { $other } that was found has half of it.

# Names of types. None of them may be a message with a value that equals its text.
path-fourbar = fourbar
path-slider-crank = slider-crank
path-geared-fivebar = geared fivebar
path-sixbar = sixbar
path-eightbar = eightbar
path-type-or-type = { $first } or { $last }
path-sixbar-name =
    { $type ->
        [watt_1] Watt I sixbar
        [stephenson_1] Stephenson I sixbar
        [stephenson_2] Stephenson II sixbar
       *[stephenson_3] Stephenson III sixbar
    }

# Cognates. The sentences about a cognate begin with path-left-cognate or path-right-cognate.
path-no-cognates = P is on a moving pivot, so that its path is a circle or an arc of one, and there are no cognates.
path-transmission-of-linkage = This linkage has a minimum transmission angle of { $angle }°.
path-transmission-of-type = This { $type } has a minimum transmission angle of { $angle }°.
path-left-cognate = The left cognate, a { $type } on ({ $input_x }, { $input_y }) and ({ $output_x }, { $output_y }),
path-right-cognate = The right cognate, a { $type } on ({ $input_x }, { $input_y }) and ({ $output_x }, { $output_y }),
path-cognate-passes-toggle = { $cognate } passes a toggle between the points when its input drives.
path-cognate-out-of-order = { $cognate } does not meet the points in order when its input turns one way.
path-cognate-with-same-timing =
    { $cognate } guides P through the points at the same crank angles;
    its minimum transmission angle is { $comparison ->
        [larger] larger
        [smaller] smaller
       *[equal] equal
    }: { $angle }°.
path-cognate-with-other-timing =
    { $cognate } guides P through the points, its input turning with this one's coupler;
    its minimum transmission angle is { $comparison ->
        [larger] larger
        [smaller] smaller
       *[equal] equal
    }: { $angle }°.

# Names of the motions of fourbars.
path-double-crank = double-crank
path-crank-rocker = crank-rocker
path-rocker-crank = rocker-crank
path-double-rocker = double-rocker
path-rocker-rocker = rocker-rocker
path-change-point = change-point
