### Function generation: linkages whose output follows their input.

## Faults of a problem. Each follows the name of a field.

# The reason of a fault that the model completes by advice.
function-class-needs-fourbar = applies only to fourbars; a slider-crank has no class
function-pivots-coincide = equals the input's pivot; the ground link would have length zero
function-range-limits-outside = must lie between { $lowest } and { $highest } degrees
function-range-outside = a range must lie between { $lowest } and { $highest } degrees
function-scales-not-positive = scales must be positive
function-pairs-or-function = give either pairs or a function
function-field-is-for-functions = applies only to a function; pairs define their own
function-scales-are-for-pairs = applies only to pairs; a function has ranges
# $criterion is a value of the field criterion.
function-criterion-uses-no-points = { $criterion } approximates the whole range and uses no precision points
function-inputs-equal = equals that of pair { $pair }; inputs must differ
function-inputs-cover-turn = the inputs cover a full turn or more
function-inputs-unordered = inputs must rise, or fall, from pair to pair, unless in_order is false
function-outputs-cover-turn = the outputs cover a full turn or more
function-output-rests = the output does not move
function-too-many-pairs = at most { $count } pairs can be met exactly; leave zeros or scales open, or use another criterion
function-too-many-sixbar-pairs = at most { $count } pairs can be met exactly; request only watt_2 for nine, or use another criterion
function-too-many-points = at most { $count } points can be exact; leave zeros or ranges open
function-too-many-sixbar-points = at most { $count } points can be exact; request only watt_2 for nine
function-slider-range-missing = a slider's range sets the size of the linkage and must be given
function-slider-scale-missing = must be given: a slider's scale only changes the linkage's size
function-nine-pairs-need-it = must be given, because nine pairs leave finitely many sixbars only then
function-sixbar-output-rotates = the output of sixbars and eightbars rotates; remove them from mechanisms
function-zeros-need-fourbar = are measured from the ground line of a fourbar; leave them open for sixbars and eightbars
function-slider-crank-not-alone = slider_crank has a length as output, all other types an angle: list it alone, and set mechanism to it too

## Faults of a mathematical function; $function is its name in the request.

function-table-not-rising = x must rise from row to row of a table
function-table-too-short = the table does not cover this interval
function-interval-missing = give the interval of x
function-interval-too-short = the interval is too short relative to its values
function-values-infinite = { $function } is not finite over this interval
function-values-constant = { $function } is constant over this interval, to numerical precision
function-field-unused = applies only to { $function }
function-field-required = is required for { $function }
function-base-unused = applies only to exponential and logarithm
function-base-one = a base of 1 makes the function constant
function-exponent-zero = an exponent of 0 makes the function constant
function-logarithm-of-zero = the logarithm needs an interval above 0
function-reciprocal-of-zero = 1/x is undefined at 0, which lies in the interval
function-tangent-undefined = the tangent is undefined at { $angle }°, inside the interval
function-negative-power-of-zero = a negative power is undefined at 0, which lies in the interval
function-power-of-negative = a non-integer exponent needs an interval without negative values

## Progress. $type is the name of a type in the request, such as watt_2.

function-reading-problem = reading the problem
function-solving-scales = solving for scales
function-family-members = { $count ->
        [one] { $count } member of the family
       *[other] { $count } members of the family
    }
function-fitting-family = moving family members into the limits
function-starts = { $count ->
        [one] { $count } start
       *[other] { $count } starts
    }
function-improving-start = start { $number } of { $count }
function-improving-candidate = candidate { $number }
function-linkages-of-type = { $type ->
        [eightbar] { $count ->
            [one] { $count } eightbar
           *[other] { $count } eightbars
        }
       *[other] { $count ->
            [one] { $count } sixbar of type { $type }
           *[other] { $count } sixbars of type { $type }
        }
    }
function-following-linkages = following the best of { $linkages }
function-improving-linkages = improving the best of { $linkages }
function-paths-followed = { $done } of { $count } paths followed
function-paths-to-nine-followed = { $done } of { $count } paths to nine of the pairs followed
function-verifying-best-linkages = verifying the best of { $count } linkages
function-verifying = verifying
function-verified = verified

## Summaries

function-values-read-as-angles = The values were read as angles from the ground line; the zeros may be left open instead.
# The summary of the search with open zeros follows.
function-zeros-left-open = No linkage with the values as angles from the ground line satisfies all constraints. With the zeros left open:
# $unit is a degree sign, or a unit of length with a space before it.
function-least-maximum =
    Smallest maximum structural error found: { $maximum }{ $unit } ({ $extremes ->
        [one] { $extremes } alternating extreme
       *[other] { $extremes } alternating extremes
    }). { $improved } of { $count ->
        [one] { $count } start
       *[other] { $count } starts
    } { $improved ->
        [one] was
       *[other] were
    } optimised; a better linkage may exist.
function-least-rms =
    Smallest root-mean-square structural error found: { $rms }{ $unit } (maximum { $maximum }{ $unit }). { $improved } of { $count ->
        [one] { $count } start
       *[other] { $count } starts
    } { $improved ->
        [one] was
       *[other] were
    } optimised; a better linkage may exist.
function-no-start-passes =
    No design found: { $improved } of { $count ->
        [one] { $count } start
       *[other] { $count } starts
    } { $improved ->
        [one] was
       *[other] were
    } optimised, but none satisfies all constraints.
function-real-linkages-pass =
    { $passed } of { $count ->
        [one] { $count } real linkage
       *[other] { $count } real linkages
    } { $passed ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
# These sentences follow the number of linkages that satisfy the constraints, which is 0.
function-no-design-exists = These are all, so no design exists.
function-no-such-type-exists = These are all, so no design of this type exists.
function-others-may-exist = Others may exist.
function-designs-among-candidates =
    { $found ->
        [one] { $found } design
       *[other] { $found } designs
    } found among { $count ->
        [one] { $count } candidate
       *[other] { $count } candidates
    }.
# $computed of $count solutions were found; $accepted of the $real real ones satisfy the constraints.
function-watts-computed =
    { $computed } of { $count } Watt II solutions for the nine pairs were computed, real and complex; { $real ->
        [one] { $real } is
       *[other] { $real } are
    } real, and { $accepted } of these { $accepted ->
        [one] satisfies
       *[other] satisfy
    } all constraints.
# $pairs is "nine" if there are nine pairs, and "more" if nine of them were selected. $met may be 0.
function-watts-meet-pairs =
    All { $count } Watt II solutions for { $pairs ->
        [nine] the nine pairs
       *[more] nine of the pairs
    }, real and complex, were computed; { $met ->
        [0] none of them meets
        [one] { $met } of them meets
       *[other] { $met } of them meet
    } all pairs to a millionth of a degree in one assembly.
function-many-watts-meet-pairs =
    All { $count } Watt II solutions for { $pairs ->
        [nine] the nine pairs
       *[more] nine of the pairs
    }, real and complex, were computed; at least { $met } of them meet all pairs to a millionth of a degree in one assembly.
function-linkages-sampled = { $family ->
        [eightbar] { $sampled ->
            [one] { $sampled } eightbar was sampled
           *[other] { $sampled } eightbars were sampled
        }
       *[sixbar] { $sampled ->
            [one] { $sampled } sixbar was sampled
           *[other] { $sampled } sixbars were sampled
        }
    }
function-no-linkage-passes = { $effort }; no design found satisfies all constraints.
function-nothing-proved = This does not prove that none exists.
function-linkages-meet-pairs =
    { $effort }; { $count ->
        [one] { $count } design meets
       *[other] { $count } distinct designs meet
    } all pairs.
function-linkage-type = { $type ->
        [watt_2] a Watt II sixbar
        [stephenson_2] a Stephenson II sixbar
        [eightbar] an eightbar
       *[stephenson_3] a Stephenson III sixbar
    }
function-linkage-with-least-rms =
    { $effort }. Smallest root-mean-square structural error found: { $rms }° (maximum { $maximum }°), by { $type }. A better
    linkage may exist.
function-linkage-with-least-maximum =
    { $effort }. Smallest maximum structural error found: { $maximum }°, by { $type }. A better linkage may exist.

## Comparison of fourbars with sixbars, and of these with eightbars

function-only-sixbars-found = No fourbar was found, only sixbars.
function-no-linkage-found = Neither a fourbar nor a sixbar was found.
function-no-smaller-error = No sixbar found clearly improves on the best fourbar's error.
function-no-better-transmission = No sixbar found clearly improves on the best fourbar's transmission angle.
function-only-eightbars-found = No linkage with fewer links was found, only eightbars.
function-no-eightbar-found = Neither an eightbar nor a linkage with fewer links was found.
function-no-eightbar-with-smaller-error = No eightbar found clearly improves on the error of the best linkage with fewer links.
function-no-eightbar-transmits-better =
    No eightbar found clearly improves on the transmission angle of the best linkage with fewer links.
# A full stop follows these four, or the rest of the sentence: whether the linkages with more links are listed.
function-sixbars-transmit-better = The best fourbar has a minimum transmission angle of only { $angle }°; sixbars exceed it
function-sixbars-reduce-error = Sixbars reduce the error to { $share } % of the best fourbar's
function-eightbars-transmit-better =
    The best linkage with fewer links has a minimum transmission angle of only { $angle }°; eightbars exceed it
function-eightbars-reduce-error =
    Eightbars reduce the error to { $share } % of that of the best linkage with fewer links

## Progress

function-progress-sixbars = verifying { $next } of { $all } sixbars
