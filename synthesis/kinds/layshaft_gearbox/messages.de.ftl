# Contradictions.

layshaft_gearbox-ratios-not-falling = muss kleiner als die Übersetzung des vorhergehenden Gangs sein
layshaft_gearbox-size-needs-tolerance = die Rangfolge nach Größe braucht eine Toleranz der Übersetzungen
layshaft_gearbox-tooth-sum-too-large = höchstens { $limit }

# Progress of the search.

layshaft_gearbox-searching-tooth-sum = Zähnesumme { $sum }
layshaft_gearbox-done = fertig

# Summary. $searched: the combinations searched.

layshaft_gearbox-best =
    { $count ->
        [one] Mit der Zähnesumme { $sum } weicht die Übersetzung höchstens { $error } % ab; { $searched }.
       *[other] Mit der Zähnesumme { $sum } weichen alle { $count } Übersetzungen höchstens { $error } % ab;
            { $searched }.
    }
layshaft_gearbox-none-within-limits = Kein Getriebe hält die Grenzen ein; { $searched }.
layshaft_gearbox-none-within-tolerance =
    Kein Getriebe hält alle Übersetzungen innerhalb der Toleranz ein: Das beste hat einen Fehler von { $error } %;
    { $searched }.
layshaft_gearbox-combinations-searched =
    { $count ->
        [one] { $count } Kombination von Zähnezahlen untersucht
       *[other] { $count } Kombinationen von Zähnezahlen untersucht
    }
