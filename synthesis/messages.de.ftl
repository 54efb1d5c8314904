# Errors

synthesis-unknown-kind = kind ist anzugeben; möglich sind: { $kinds }

# Summaries

synthesis-designs-without-constraints =
    { $count ->
        [one] { $count } Entwurf, der ohne die Bedingungen gefunden wurde, erfüllt sie dennoch.
       *[other] { $count } Entwürfe, die ohne die Bedingungen gefunden wurden, erfüllen sie dennoch.
    }

# Progress

synthesis-searching-nearest-miss = nichts gefunden; der nächstliegende Entwurf wird gesucht
