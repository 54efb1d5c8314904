# Names of checks, metrics and limits in words. German selects by the name; English writes it with spaces

results-name-in-words =
    { $name ->
       *[other] { $words }
    }

# Parts of sentences

results-quantity = { $number } { $unit }
results-list-with-and = { $first } and { $last }

# Reasons of rejection with the number of candidates

results-reason-with-count = { $reason } { $count }
results-rejected = Rejected: { $reasons }.

# Why the forces of a design are unknown; the reasons follow the colon of forces-unknown

results-forces-unknown = Its forces are not known: { $reason }.
results-no-mechanism-from-dimensions = no mechanism can be built from these dimensions
results-no-verified-motion = the design has no verified motion
results-sliding-speed-missing = the input of this linkage slides; give its speed
results-rotating-speed-missing = the input of this linkage turns; give its speed

# Order of the designs by a measured quantity

results-ranked-by-planes =
    { $count ->
        [one] Ranked by planes ({ $count } design arranged in planes): they need { $minimum } to { $maximum }.
       *[other] Ranked by planes ({ $count } designs arranged in planes): they need { $minimum } to { $maximum }.
    }
results-ranked-by-planes-equal =
    { $count ->
        [one] Ranked by planes ({ $count } design arranged in planes): every buildable one needs { $planes }.
       *[other] Ranked by planes ({ $count } designs arranged in planes): every buildable one needs { $planes }.
    }
results-ranked-by-planes-none-buildable =
    { $count ->
        [one] Ranked by planes ({ $count } design arranged in planes): none of them can be built.
       *[other] Ranked by planes ({ $count } designs arranged in planes): none of them can be built.
    }
results-ranked-by-measure =
    { $count ->
        [one] Ranked by { $name } ({ $count } design measured): from { $minimum } to { $maximum }.
       *[other] Ranked by { $name } ({ $count } designs measured): from { $minimum } to { $maximum }.
    }
results-ranked-by-equal-measure =
    { $count ->
        [one] Ranked by { $name } ({ $count } design measured): { $value }.
       *[other] Ranked by { $name } ({ $count } designs measured): { $value }.
    }
results-ranked-by-unknown-measure =
    { $count ->
        [one] Ranked by { $name } ({ $count } design measured): none of them has a known { $name }.
       *[other] Ranked by { $name } ({ $count } designs measured): none of them has a known { $name }.
    }

# Order of the designs by practicality; a band is the permitted multiple of the smallest error

results-no-design-practical =
    { $among ->
        [buildable] None of these designs that can be built has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
        [listed] None of these designs has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
       *[found] No design found has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
    }
results-no-near-design-practical =
    { $among ->
        [buildable] None of these designs that can be built and are within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
        [listed] None of these designs within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
       *[found] No design found within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less and no link longer than { $reach } times the task's size.
    }
results-no-design-with-even-links =
    { $among ->
        [buildable] None of these designs that can be built has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
        [listed] None of these designs has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
       *[found] No design found has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
    }
results-no-near-design-with-even-links =
    { $among ->
        [buildable] None of these designs that can be built and are within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
        [listed] None of these designs within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
       *[found] No design found within { $band } times the smallest error has a transmission angle of { $angle }° or more and a link ratio of { $ratio } or less.
    }
results-sound-found-by-limits =
    { $count ->
        [one] A second search, which required a transmission angle of { $angle }° and a link ratio of { $ratio }, found { $count } design; its error is { $error }.
       *[other] A second search, which required a transmission angle of { $angle }° and a link ratio of { $ratio }, found { $count } designs; their smallest error is { $error }.
    }
results-sound-found-far = A second search, which required a transmission angle of { $angle }° and a link ratio of { $ratio }, found no design with an error below { $error }.
results-sound-before-accurate = They come before designs that are more accurate but not sound.
results-first-for-soundness = The error of the first design is { $error } and that of design { $number } { $nearest }, but the first design has a transmission angle of { $angle }° instead of { $nearest_angle }° and a link ratio of { $ratio } instead of { $nearest_ratio }.
results-first-less-accurate = Design { $number } is more accurate: its error is { $nearest } instead of { $error }.
results-unbuildable-last =
    { $count ->
        [one] One design is listed last because it cannot be built: its links would have to be narrower than { $share } % of the longest link's length, or would collide in every arrangement in planes.
       *[other] { $count } designs are listed last because they cannot be built: their links would have to be narrower than { $share } % of the longest link's length, or would collide in every arrangement in planes.
    }
results-none-buildable = None of these designs can be built as usual: the links of the first would be at most { $width } { $unit } wide, less than { $share } % of its longest link.
results-none-buildable-in-planes = None of these designs can be built: links or pins collide in every arrangement in planes.
results-unbuildable-in-layout =
    { $count ->
        [one] One design cannot be built with the sizes of the layout and is listed last.
       *[other] { $count } designs cannot be built with the sizes of the layout and are listed last.
    }
results-none-buildable-in-layout = None of these designs can be built with the sizes of the layout over the whole motion.
results-extra-links = Design { $number } has { $links } more links than design { $simple }: its minimum transmission angle is { $changed }° instead of { $angle }°.
results-extra-links-and-error = Design { $number } has { $links } more links than design { $simple }: its error is { $other } instead of { $error }, and its minimum transmission angle { $changed }° instead of { $angle }°.
results-extra-links-and-negligible-error = Design { $number } has { $links } more links than design { $simple }: its error is { $other } instead of { $error }, a difference below usual tolerances, and its minimum transmission angle { $changed }° instead of { $angle }°.

# Rounding to a grid

results-rounded = Rounded to the grid: { $kept } of { $count } designs still satisfy every constraint.

# Ends of sentences that compare other types of linkage with the best simpler one; they follow the last word

results-alternatives-not-listed = ; they are not listed because of max_designs.
results-alternatives-listed-too = {" "}and are listed with it.
results-alternatives-listed-instead = {" "}and are listed in its place.

# Progress

results-verifying = verifying
results-verified = verified
