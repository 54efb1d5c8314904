# Contradictions.

layshaft_gearbox-ratios-not-falling = must be below the ratio of the previous gear
layshaft_gearbox-size-needs-tolerance = ranking by size needs a tolerance for the ratios
layshaft_gearbox-tooth-sum-too-large = at most { $limit }

# Progress of the search.

layshaft_gearbox-searching-tooth-sum = tooth sum { $sum }
layshaft_gearbox-done = done

# Summary. $searched: the combinations searched.

layshaft_gearbox-best =
    { $count ->
        [one] A tooth sum of { $sum } keeps the ratio within { $error } %; { $searched }.
       *[other] A tooth sum of { $sum } keeps all { $count } ratios within { $error } %; { $searched }.
    }
layshaft_gearbox-none-within-limits = No gearbox keeps the limits; { $searched }.
layshaft_gearbox-none-within-tolerance =
    No gearbox keeps all ratios within the tolerance: the best has an error of { $error } %; { $searched }.
layshaft_gearbox-combinations-searched =
    { $count ->
        [one] { $count } combination of tooth numbers searched
       *[other] { $count } combinations of tooth numbers searched
    }
