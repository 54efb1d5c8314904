# Errors of the statement

indexing-field-required = required for { $drive }
indexing-field-not-for-drive = not applicable to { $drive }; omit it
indexing-too-many-stations = a Geneva drive has at most { $count } stations
indexing-center-distance-missing = give the center distance as well, or omit both
indexing-crank-radius-out-of-range = must be between { $minimum } (entry without shock) and { $maximum }: a smaller crank reaches no slot, a larger one the wheel's axis
indexing-no-shock-possible = only a crank larger than that of shock-free entry has a shock; give its radius, or omit this
indexing-rollers-leave-no-rest =
    { $rollers ->
        [one] with { $stations } stations the wheel only rests with at most { $rollers } roller
       *[other] with { $stations } stations the wheel only rests with at most { $rollers } rollers
    }
indexing-single-roller-only = with { $drive } the locking part is opposite the roller; only one roller is possible
indexing-crank-overhung = slots of { $drive } pass the crank's axis, so its crank is overhung; omit this
indexing-ring-has-no-bore = a ring has no bore, since the crank turns inside it; omit this
indexing-clearance-too-small = must be at least { $ratio } roller diameters, the resolution of the outlines
indexing-clearance-too-large = must be at most { $ratio } roller diameters
indexing-drag-link-for-plane-drives = a drag link drives plane Geneva drives only
indexing-crank-without-transmission-angle = a crank has no transmission angle; choose a drag link, or omit this

# Errors of a ratchet

indexing-field-not-for-ratchet = not applicable to a ratchet; omit it
indexing-ratchet-without-entry = a ratchet has no entry; omit this
indexing-tooth-thickness-missing = required: the thickness of a tooth at its foot
indexing-no-tooth-number = no number of teeth from { $teeth } on gives these stations with this number of pawls

# Summaries

indexing-none-exists = None exists: { $reasons }.
indexing-none-found = None found: { $reasons }.
indexing-crank-drive = The wheel turns during { $angle }° of the crank and rests for { $share } % of the time; { $size }.
indexing-drag-link-drive = The wheel turns during { $angle }° of the drag link's input and rests for { $share } % of the time; { $size }.
indexing-ratchet =
    { $pawls ->
        [one] A wheel of { $teeth } teeth with one pawl stops every { $step }°; { $size }. Its faces lean over by { $angle }°.
       *[other] A wheel of { $teeth } teeth with { $pawls } pawls stops every { $step }°; { $size }. Its faces lean over by { $angle }°.
    }

# Sizes, which the sentences crank-drive, drag-link-drive and ratchet contain

indexing-drive-size = its size is { $size }
indexing-smallest-drive-size = the smallest size is { $size }, set by its { $limit }
indexing-wheel-diameter = diameter { $diameter }
indexing-smallest-wheel-diameter = diameter { $diameter }, set by its { $limit }

# Progress

indexing-sizing = sizing
