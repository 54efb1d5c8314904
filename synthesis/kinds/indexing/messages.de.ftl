# Errors of the statement

indexing-field-required = für { $drive } nötig
indexing-field-not-for-drive = bei { $drive } nicht anwendbar; weglassen
indexing-too-many-stations = ein Malteserkreuzgetriebe hat höchstens { $count } Stationen
indexing-center-distance-missing = auch den Achsabstand angeben oder beide weglassen
indexing-crank-radius-out-of-range = muss zwischen { $minimum } (stoßfreier Eintritt) und { $maximum } liegen: Eine kleinere Kurbel erreicht keinen Schlitz, eine größere die Achse des Rads
indexing-no-shock-possible = nur eine Kurbel, die größer als die für stoßfreien Eintritt ist, hat einen Stoß; ihren Radius angeben oder dieses Feld weglassen
indexing-rollers-leave-no-rest =
    { $rollers ->
        [one] bei { $stations } Stationen rastet das Rad nur mit höchstens { $rollers } Rolle
       *[other] bei { $stations } Stationen rastet das Rad nur mit höchstens { $rollers } Rollen
    }
indexing-single-roller-only = bei { $drive } liegt der Sperrteil der Rolle gegenüber; nur eine Rolle ist möglich
indexing-crank-overhung = Schlitze von { $drive } laufen über die Achse der Kurbel, die daher fliegend gelagert ist; dieses Feld weglassen
indexing-ring-has-no-bore = ein Ring hat keine Bohrung, da sich die Kurbel in ihm dreht; dieses Feld weglassen
indexing-clearance-too-small = muss mindestens { $ratio } Rollendurchmesser betragen, die Auflösung der Umrisse
indexing-clearance-too-large = darf höchstens { $ratio } Rollendurchmesser betragen
indexing-drag-link-for-plane-drives = eine Doppelkurbel treibt nur ebene Malteserkreuzgetriebe an
indexing-crank-without-transmission-angle = eine Kurbel hat keinen Übertragungswinkel; eine Doppelkurbel wählen oder dieses Feld weglassen

# Errors of a ratchet

indexing-field-not-for-ratchet = bei einem Gesperre nicht anwendbar; weglassen
indexing-ratchet-without-entry = ein Gesperre hat keinen Eintritt; dieses Feld weglassen
indexing-tooth-thickness-missing = nötig: die Dicke eines Zahns an seinem Fuß
indexing-no-tooth-number = keine Zähnezahl ab { $teeth } ergibt diese Stationen mit dieser Anzahl von Klinken

# Summaries

indexing-none-exists = Es gibt keinen Entwurf: { $reasons }.
indexing-none-found = Kein Entwurf gefunden: { $reasons }.
indexing-crank-drive = Das Rad dreht sich während { $angle }° der Kurbel und rastet { $share } % der Zeit; { $size }.
indexing-drag-link-drive = Das Rad dreht sich während { $angle }° des Antriebs der Doppelkurbel und rastet { $share } % der Zeit; { $size }.
indexing-ratchet =
    { $pawls ->
        [one] Ein Rad mit { $teeth } Zähnen und einer Klinke wird alle { $step }° gehalten; { $size }. Seine Zahnflanken sind um { $angle }° geneigt.
       *[other] Ein Rad mit { $teeth } Zähnen und { $pawls } Klinken wird alle { $step }° gehalten; { $size }. Seine Zahnflanken sind um { $angle }° geneigt.
    }

# Sizes, which the sentences crank-drive, drag-link-drive and ratchet contain

indexing-drive-size = seine Größe beträgt { $size }
indexing-smallest-drive-size = die kleinste Größe beträgt { $size }, bestimmt durch: { $limit }
indexing-wheel-diameter = Durchmesser { $diameter }
indexing-smallest-wheel-diameter = Durchmesser { $diameter }, bestimmt durch: { $limit }

# Progress

indexing-sizing = Auslegung läuft
