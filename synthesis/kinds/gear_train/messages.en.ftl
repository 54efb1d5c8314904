# Contradictions of the stages that are given one by one.

gear_train-stages-and-max-stages =
    { $count ->
        [one] { $count } stage is given; omit max_stages
       *[other] { $count } stages are given one by one; omit max_stages
    }
gear_train-stock-has-no-types = the gears of a stock have no type; give driver and driven of the stages instead
gear_train-shafts-not-parallel = the shafts of a { $type } stage are not parallel; omit reverted
# $fields: names of fields, separated by commas
gear_train-teeth-not-fittable = the teeth of { $type } stages cannot be fitted; omit { $fields }
gear_train-strength-not-estimated = the strength of { $type } stages is not estimated; omit strength
gear_train-face-too-narrow-for-contact =
    the contact stress of these helical teeth is only known for faces from { $least } modules, at which they overlap by
    one pitch
gear_train-strength-determines-face = the strength determines the face; omit the face width, or omit strength
gear_train-bevel-without-cones = these bevel gears have no cones at this angle
gear_train-pinion-not-in-ring =
    the pinion does not run in the ring: their tips or fillets interfere; give the ring more teeth, or the pinion fewer
gear_train-direction-without-meaning =
    a direction has no meaning for intersecting or crossed shafts: it depends on the side on which gears are placed;
    give only the size of the ratio
gear_train-stages-turn-same =
    with these stages input and output turn in the same direction; use one internal stage more, or one less
gear_train-stages-turn-opposite =
    with these stages input and output turn in opposite directions; use one internal stage more, or one less
gear_train-ring-in-other-stage = only an internal stage has a ring; omit it
# $gear: driver or driven
gear_train-ring-too-small =
    the { $gear } gear is the ring and needs more teeth than its pinion; set `ring` if it is the other gear
gear_train-required-for-type = required for a { $type } stage
gear_train-teeth-out-of-range = expected { $least } to { $most } teeth
gear_train-threads-out-of-range = expected { $least } to { $most } threads
gear_train-too-many-given-pairs = more than { $limit } pairs of gears for a { $type } stage; narrow the ranges

# Contradictions between other fields.

gear_train-negative-ratio-same-direction = a negative ratio means opposite directions; omit the sign or the direction
gear_train-module-and-pitch = the module already determines the pitch; give only one of them
gear_train-stock-and-teeth = the stock already determines the tooth numbers; omit teeth or stock
gear_train-reverted-single-stage = a reverted train has at least two stages; raise max_stages
gear_train-range-count-wrong =
    { $stages ->
        [one] expected { $ranges } ranges, driver and driven gear of { $stages } stage, got { $given }
       *[other] expected { $ranges } ranges, driver and driven gear of { $stages } stages, got { $given }
    }
gear_train-max-undercut = below { $least }, the fewest teeth without undercut; give min as well
gear_train-stage-module-repeats = lists a module twice; each is a choice for every stage
gear_train-modules-incommensurable = the modules have no common measure; round them
gear_train-module-count-wrong =
    { $stages ->
        [one] expected the module of { $stages } stage, got { $given }
       *[other] expected the modules of { $stages } stages, got { $given }
    }
# $gear: driver or driven
gear_train-range-excludes-gear = does not contain the { $gear } gear that stage { $stage } gives; omit one of them
gear_train-modules-and-pitch = omit { $field }, or omit modules
gear_train-modules-repeat = lists a module twice; each is a choice
gear_train-reverted-distance-list = a reverted train has one distance for all stages; give a number
gear_train-distance-count-wrong =
    { $stages ->
        [one] expected the distance of { $stages } stage, got { $given }
       *[other] expected the distances of { $stages } stages, got { $given }
    }

# Searches that are too large.

gear_train-too-many-fitted =
    { $count } tooth numbers are given; at most { $limit } can be fitted in pairs to an open distance; narrow the range
    or give the distance
# $covered, $limit: rounded numbers such as 4e+08
gear_train-too-many-gear-choices =
    { $stages ->
        [one] about { $covered } choices of drivers or driven gears in { $stages } stage exceed the limit of { $limit };
            narrow the tooth numbers
       *[other] about { $covered } choices of drivers or driven gears in { $stages } stages exceed the limit of
            { $limit }; narrow the tooth numbers or allow fewer stages
    }
gear_train-too-many-mesh-combinations =
    { $stages ->
        [one] about { $covered } combinations of meshes in { $stages } stage exceed the limit of { $limit }; narrow the
            tooth numbers
       *[other] about { $covered } combinations of meshes in { $stages } stages exceed the limit of { $limit }; narrow
            the tooth numbers or allow fewer stages
    }

# Progress of the search.

gear_train-listing-gears = listing gears
# $trains: a rounded number such as 1.23e+08
gear_train-searching-stages =
    { $stages ->
        [one] { $stages } stage: { $trains } trains
       *[other] { $stages } stages: { $trains } trains
    }
gear_train-searching-nearest = few trains are within the tolerance; searching for the nearest
gear_train-searching-hunting-teeth = searching trains with hunting teeth
gear_train-verified = verified

# Summary: the best train. $meshes: its pairs of tooth numbers, such as 20:43, 17:58.

gear_train-first-is-undercut = In the first train, the rack that cuts the gears undercuts those with { $teeth } teeth, which have no profile shift.
gear_train-best-exact = { $meshes } has exactly the requested ratio.
gear_train-best-exact-of-ties =
    { $ties ->
        [one] { $meshes } has exactly the requested ratio; no other train is as close.
       *[other] { $meshes } has exactly the requested ratio; { $ties } trains are as close.
    }
gear_train-best-nearest = { $meshes } has a relative error of { $error }.
gear_train-best-nearest-of-ties =
    { $ties ->
        [one] { $meshes } has a relative error of { $error }; no other train is as close.
       *[other] { $meshes } has a relative error of { $error }; { $ties } trains are as close.
    }
gear_train-best-smallest =
    { $meshes } is the smallest train within { $tolerance } %, with a relative error of { $error }.

# Summary: the trains that were searched.

gear_train-proven =
    { $count ->
        [one] Proven: only { $count } train has the given tooth numbers.
       *[other] Proven over all { $count } trains with the given tooth numbers.
    }
gear_train-proven-with-given-gears =
    { $count ->
        [one] Proven: only { $count } train has the given tooth numbers, with the gears given by stages unchanged.
       *[other] Proven over all { $count } trains with the given tooth numbers, with the gears given by stages
            unchanged.
    }
gear_train-best-of-searched =
    { $count ->
        [one] It is the only train with the given tooth numbers.
       *[other] It is the best of all { $count } trains with the given tooth numbers.
    }
gear_train-distances-in-steps =
    Feasible centre distances are searched in steps of the sum of shifts, so this is not proven.

# Summary without a train. $reason: one of the reasons below.

gear_train-none-verified = No train passed the verification.
gear_train-none-found = No train found: { $reason }.
gear_train-none-exists = No such train exists: { $reason }.

gear_train-two-stages-turn-same =
    in a reverted train of two stages, input and output turn in the same direction; allow three stages
gear_train-stock-too-small =
    { $count ->
        [one] a stock of { $count } gear is too small for such a train
       *[other] a stock of { $count } gears is too small for such a train
    }
gear_train-no-stage-count = no number of stages satisfies the constraints
gear_train-no-stage = no two gears form a stage that satisfies the constraints
gear_train-nearest-too-far =
    the nearest train, { $meshes }, has a relative error of { $error }, which exceeds the tolerance
gear_train-ratio-unreachable =
    { $stages ->
        [one] the ratio { $ratio } is out of reach; the permitted meshes give { $least } to { $most } in { $stages }
            stage
       *[other] the ratio { $ratio } is out of reach; the permitted meshes give { $least } to { $most } in { $stages }
            stages
    }
gear_train-no-combination = no combination of gears satisfies all constraints
