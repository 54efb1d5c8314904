# Contradictions of the members and the tooth numbers.

# $members: names of all members, separated by commas; $member: the given one, in quotation marks
planetary_train-unknown-member = expected one of { $members }, got { $member }
planetary_train-member-repeats = { $member } already has another role
planetary_train-no-arrangement-fits = no arrangement has all the given members
planetary_train-max-below-min = must not be below min
planetary_train-unknown-gear = expected one of { $gears }
planetary_train-order-needs-tolerance = ranking by { $order } needs a tolerance for the ratio
planetary_train-ring-diameter-needs-module = needs one module; omit modules
planetary_train-efficiency-without-strength = is not supported together with strength
# $arrangement: as in the problem, such as two_stage; $combinations, $limit: rounded numbers such as 2e+08
planetary_train-too-many-combinations =
    { $arrangement } has { $combinations } combinations of teeth, more than the limit of { $limit }; narrow the limits,
    or give limits for single gears

# Contradictions of a power and of modules to choose from.

planetary_train-modules-need-power = choosing between modules needs a power; give strength, or one module
planetary_train-module-and-modules = omit module, or omit modules
planetary_train-modules-repeat = lists a module twice; each is a choice
planetary_train-strength-of-bevel-gears = strength is estimated for spur gears only, not for bevel gears

# Progress of the search. $arrangement: as in the problem.

planetary_train-listing-teeth = { $arrangement }: tooth numbers
planetary_train-searching-members = { $arrangement }: { $input } to { $output }
planetary_train-judging-strength = judging the strength of the trains
planetary_train-done = done

# Summary. $arrangement: as in the problem. $searched: the combinations searched, and the number of equally exact
# trains if there are several.

planetary_train-best-exact =
    The { $arrangement ->
        [double_planet] double planet
        [stepped_suns] stepped suns
        [stepped_rings] stepped rings
        [two_stage] two stage
        [bevel_differential] bevel differential
       *[other] { $arrangement }
    } arrangement reaches { $ratio } exactly; { $searched }.
planetary_train-best-nearest =
    The { $arrangement ->
        [double_planet] double planet
        [stepped_suns] stepped suns
        [stepped_rings] stepped rings
        [two_stage] two stage
        [bevel_differential] bevel differential
       *[other] { $arrangement }
    } arrangement reaches { $ratio } with an error of { $error } %; { $searched }.
planetary_train-set-without-effect =
    With these members a planet set does not affect the ratio; choose a simpler arrangement.
planetary_train-none-within-limits = No train keeps the limits: { $searched } ({ $reasons }).
planetary_train-none-permitted = the limits permit none
planetary_train-none-turns-same =
    With these members no train turns input and output in the same direction; { $searched }.
planetary_train-none-turns-opposite =
    With these members no train turns input and output in the opposite direction; { $searched }.
# $teeth: tooth numbers by gear, such as sun 20, planet 31; $input, $output, $fixed: members
planetary_train-none-within-tolerance =
    No train is within the tolerance: { $searched }. The nearest ratio is { $ratio }, by { $arrangement } ({ $teeth };
    { $input } to { $output }, { $fixed } fixed), with an error of { $error } %.
planetary_train-none-efficient = None of the { $count } trains within the tolerance has an efficiency of { $efficiency }; the greatest is { $greatest }.
planetary_train-none-judged-efficient = None of the { $count } trains judged has an efficiency of { $efficiency }; the greatest is { $greatest }. More trains are within the tolerance.
planetary_train-combinations-searched =
    { $count ->
        [one] { $count } combination of tooth numbers and members searched
       *[other] { $count } combinations of tooth numbers and members searched
    }
planetary_train-ties = { $count } trains have this error
