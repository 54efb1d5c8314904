# Contradictions between mechanism and output.
quick_return-no-output = give either the swing or the stroke of the output; neither is given
quick_return-two-outputs = give either the swing or the stroke of the output; both are given
quick_return-swing-missing = the output of a { $mechanism } swings; give its swing
quick_return-stroke-of-rocker = the output of a { $mechanism } swings; leave the stroke out
quick_return-stroke-missing = the output of a { $mechanism } slides; give its stroke
quick_return-swing-of-slider = the output of a { $mechanism } slides; leave the swing out
quick_return-slider-with-rotopole = an output that slides has no fixed pivot; leave it out
quick_return-rotopole-for-crank-rocker-only = only a crank-rocker can be placed at a rotopole; choose mechanism fourbar
quick_return-crank-pivot-with-rotopole = the rotopole places the linkage; leave this out

# Reasons why a required class of fourbars is impossible.
quick_return-mechanism-without-class = its crank turns through, and the requested mechanism is of no class of fourbars
quick_return-mechanism-is-crank-rocker = its crank turns through, and the requested mechanism is crank-rocker
quick_return-mechanism-is-double-crank = its crank turns through, and the requested mechanism is double-crank
quick_return-mechanism-is-either = its crank turns through, and the requested mechanism is crank-rocker or double-crank

# Contradictions with the positions of a body.
quick_return-field-with-positions = the positions of the body determine this; leave the { $field } out
quick_return-body-needs-fourbar = a body is carried by the rocker of a fourbar
quick_return-body-does-not-turn = the body must turn between its positions; a translation has no rotopole
quick_return-rotopole-differs = the positions have theirs at ({ $x }, { $y }); leave it out or correct it

# Progress.
quick_return-designing = designing: { $type }
quick_return-verified = verified

# Names of types. In German they begin with a noun, because sentences begin with them.
quick_return-fourbar = fourbar
quick_return-drag-link-rocker = drag link rocker
quick_return-offset-slider-crank = offset slider crank
quick_return-slider-crank = slider crank
quick_return-crank-shaper = crank shaper
quick_return-whitworth = whitworth
quick_return-drag-link-slider = drag link slider

# Reasons for the ends of the range of time ratios.
quick_return-crank-rocker-swing = a crank-rocker swings by less than 180°
quick_return-crank-rocker-two-circuits =
    from { $ratio } on the limit positions of a swing of { $swing }° lie on two circuits
quick_return-drag-link-unlimited = a drag link near its change point is as uneven as one likes
quick_return-drag-link-rocker-swing = its rocker is that of a crank-rocker, which swings by less than 180°
quick_return-coupler-square-to-slide = from 3 on the coupler would have to pass square to the slide
quick_return-equal-strokes-without-crank = equal strokes would need a crank without length
quick_return-equal-strokes-at-one-pivot = equal strokes would need both fixed pivots in one place

# Ranges of time ratios.
quick_return-from = from { $least }
quick_return-above = above { $least }
quick_return-from-to-below = from { $least } to below { $greatest }
quick_return-above-to-below = above { $least } to below { $greatest }

# Summaries.
quick_return-designs-found =
    { $count ->
        [one] { $count } design has
       *[other] { $count } designs have
    } a measured time ratio of { $ratio }. The best minimum transmission angle is { $angle }°, of a { $type }.
quick_return-no-design-exists = No design exists.
quick_return-no-design-found = No design was found.
quick_return-transmission-bound =
    If a rocker swings by { $swing }°, the minimum transmission angle is below { $bound }° (90° minus half the swing).
quick_return-type-without-range =
    The { $type } cannot reach a time ratio of { $ratio }: its range with this output is none ({ $reason }).
quick_return-ratio-out-of-range =
    The { $type } cannot reach a time ratio of { $ratio }: its range with this output is { $range } ({ $reason }).
quick_return-type-does-not-exist = No { $type } exists.
quick_return-type-not-found = No { $type } was found.
quick_return-link-ratio-impossible = No { $type } with a link ratio of at most { $link_ratio } exists.
quick_return-link-ratio-not-found = No { $type } with a link ratio of at most { $link_ratio } was found.
