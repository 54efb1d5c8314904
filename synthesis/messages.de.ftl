# Errors

synthesis-unknown-kind = kind ist anzugeben; möglich sind: { $kinds }

# Summaries

synthesis-designs-without-constraints =
    { $count ->
        [one] { $count } Entwurf, der ohne die Bedingungen gefunden wurde, erfüllt sie dennoch.
       *[other] { $count } Entwürfe, die ohne die Bedingungen gefunden wurden, erfüllen sie dennoch.
    }

synthesis-designs-listed = { $listed } von { $count } Entwürfen, die bestanden haben, sind aufgeführt.
# $depth is a length with its unit.
synthesis-nearest-miss-overlaps = Der nächstliegende Entwurf ragt { $depth } tief in ein Hindernis: So weit müsste ein Teil verschoben werden, um außerhalb zu liegen.

# Progress

synthesis-searching-nearest-miss = nichts gefunden; der nächstliegende Entwurf wird gesucht
