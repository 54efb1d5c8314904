# Contradictions of the requested speeds and ratios.

gearbox-one-of-max-ratio-series = give exactly one of max, ratio and series
gearbox-max-not-above-min = max must be above min
gearbox-min-not-below-max = min must be below max
# $series: R5, R10, R20 or R40
gearbox-min-outside-series = min must be a number of the series { $series }
gearbox-speed-range-too-wide = the highest speed is more than a million times the lowest
gearbox-tolerance-exceeds-half-step =
    must be below half a step, { $half }; beyond that a speed is nearer to another nominal one

# Contradictions of the structure, and searches that are too large.

gearbox-structure-count-wrong =
    { $count ->
        [one] gives { $count } speed, but speeds.count is { $stated }
       *[other] gives { $count } speeds, but speeds.count is { $stated }
    }
gearbox-several-fixed-stages = at most one fixed stage is possible; merge the others with it
gearbox-fixed-stage-and-structure = write a fixed stage as 1 in structure
gearbox-tooth-sum-too-large = at most { $limit }
gearbox-too-many-pairs =
    permits { $count } pairs of gears for a stage, above the limit of { $limit }; narrow tooth_sum, teeth or stage_ratio

# Progress of the search.

# $formula: a structural formula such as 3(1) 2(3)
gearbox-searching-structure = structure { $formula }
gearbox-done = done

# Summary.

gearbox-speeds-not-factorable = { $count } speeds cannot be made by stages of 2 to { $pairs } pairs.
# $structures, $combinations: composed, see below
gearbox-none-found =
    No gearbox ({ $structures }, { $combinations } of tooth numbers) keeps all { $count } speeds within { $tolerance } %
    and the limits.
gearbox-best-exact =
    { $formula } keeps { $count } speeds exactly: the best of { $structures } and { $combinations } of tooth numbers.
gearbox-best-within =
    { $formula } keeps { $count } speeds within { $error } %: the best of { $structures } and { $combinations } of tooth
    numbers.
gearbox-structures =
    { $count ->
        [one] { $count } structure
       *[other] { $count } structures
    }
gearbox-combinations =
    { $count ->
        [one] { $count } combination
       *[other] { $count } combinations
    }
gearbox-unstructured-not-searched =
    At this tolerance, above a quarter of a step, gearboxes without a structural formula exist; they were not searched.
gearbox-split-stages-not-searched = Stages of four or six pairs with two characteristics were not searched.
