# Errors

synthesis-unknown-kind = kind must be given and be one of: { $kinds }

# Summaries

synthesis-designs-without-constraints =
    { $count ->
        [one] { $count } design, found by ignoring the constraints, satisfies them anyway.
       *[other] { $count } designs, found by ignoring the constraints, satisfy them anyway.
    }

synthesis-designs-listed = { $listed } of { $count } designs that passed are listed.
# $depth is a length with its unit.
synthesis-nearest-miss-overlaps = The nearest miss overlaps an obstacle by { $depth }: a part would have to be shifted that far to be outside.

# Progress

synthesis-searching-nearest-miss = no design found; searching the nearest miss
