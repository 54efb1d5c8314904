### Straight lines: a point of a linkage runs along a given line. Types of mechanism have the names of their inventors.
### Errors are written after the name of a field, without a capital and a full stop.

# Progress of a search, and its method.

straight_line-searching-type = searching { $mechanism } linkages
straight_line-verified = verified
straight_line-method = sequential linear programming in each family; exact mechanisms by their dimensions

# Errors in the problem.

straight_line-crank-range-too-large =
    the crank of { $mechanism } turns by less than { $limit }°; give less or choose another mechanism
straight_line-length-too-short = too short relative to the coordinates of the start; move the origin nearer
# Followed by "; drop the constraint".
straight_line-class-of-exact-mechanism = applies to fourbars; a { $mechanism } mechanism has no class

# Summary.

straight_line-none-found =
    No straight-line mechanism was found that satisfies all constraints ({ $reasons }). One may still exist.
straight_line-mechanisms-found =
    { $count ->
        [one] { $count } straight-line mechanism found.
       *[other] { $count } straight-line mechanisms found.
    }
straight_line-runs-on-slide = Scott-Russell's linkage itself runs on a straight slide.
straight_line-first-is-exact =
    The first, { $mechanism }'s, follows the line exactly; its velocity varies by { $variation } %.
straight_line-first-stays-in-strip =
    The first, { $mechanism }'s, stays in a strip of { $width } % of the length; its velocity varies by
    { $variation } %.
