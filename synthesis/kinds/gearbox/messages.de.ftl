# Contradictions of the requested speeds and ratios.

gearbox-one-of-max-ratio-series = genau eines von max, ratio und series angeben
gearbox-max-not-above-min = max muss größer als min sein
gearbox-min-not-below-max = min muss kleiner als max sein
gearbox-min-outside-series = min muss eine Zahl der Reihe { $series } sein
gearbox-speed-range-too-wide = die höchste Drehzahl ist mehr als das Millionenfache der niedrigsten
gearbox-tolerance-exceeds-half-step =
    muss kleiner als ein halber Stufensprung sein, { $half }; darüber liegt eine Drehzahl näher an einer anderen
    Nenndrehzahl

# Contradictions of the structure, and searches that are too large.

gearbox-structure-count-wrong =
    { $count ->
        [one] ergibt { $count } Drehzahl, aber speeds.count ist { $stated }
       *[other] ergibt { $count } Drehzahlen, aber speeds.count ist { $stated }
    }
gearbox-several-fixed-stages = höchstens eine feste Stufe ist möglich; die anderen mit ihr zusammenfassen
gearbox-fixed-stage-and-structure = eine feste Stufe als 1 in structure angeben
gearbox-tooth-sum-too-large = höchstens { $limit }
gearbox-too-many-pairs =
    lässt { $count } Räderpaare für eine Stufe zu, mehr als die Grenze von { $limit }; tooth_sum, teeth oder stage_ratio
    enger begrenzen

# Progress of the search.

gearbox-searching-structure = Struktur { $formula }
gearbox-done = fertig

# Summary.

gearbox-speeds-not-factorable =
    { $count } Drehzahlen lassen sich nicht mit Stufen von 2 bis { $pairs } Räderpaaren erzeugen.
gearbox-none-found =
    Kein Getriebe hält alle { $count } Drehzahlen innerhalb von { $tolerance } % und die Grenzen ein; untersucht:
    { $structures }, { $combinations } von Zähnezahlen.
gearbox-best-exact =
    { $formula } hält { $count } Drehzahlen genau ein. Es ist das beste Getriebe; untersucht: { $structures },
    { $combinations } von Zähnezahlen.
gearbox-best-within =
    { $formula } hält { $count } Drehzahlen auf { $error } % genau ein. Es ist das beste Getriebe; untersucht:
    { $structures }, { $combinations } von Zähnezahlen.
gearbox-structures =
    { $count ->
        [one] { $count } Struktur
       *[other] { $count } Strukturen
    }
gearbox-combinations =
    { $count ->
        [one] { $count } Kombination
       *[other] { $count } Kombinationen
    }
gearbox-unstructured-not-searched =
    Bei dieser Toleranz, die größer als ein Viertel des Stufensprungs ist, gibt es auch Getriebe ohne Strukturformel;
    sie wurden nicht untersucht.
gearbox-split-stages-not-searched = Stufen mit vier oder sechs Räderpaaren und zwei Kennmaßen wurden nicht untersucht.
