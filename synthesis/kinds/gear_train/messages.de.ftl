# Contradictions of the stages that are given one by one.

gear_train-stages-and-max-stages =
    { $count ->
        [one] { $count } Stufe ist angegeben; max_stages weglassen
       *[other] { $count } Stufen sind einzeln angegeben; max_stages weglassen
    }
gear_train-stock-has-no-types =
    die Räder eines Vorrats haben keine Art; stattdessen driver und driven der Stufen angeben
gear_train-shafts-not-parallel = die Wellen einer Stufe der Art { $type } sind nicht parallel; reverted weglassen
gear_train-teeth-not-fittable =
    die Verzahnung einer Stufe der Art { $type } lässt sich nicht anpassen; { $fields } weglassen
gear_train-strength-not-estimated =
    die Tragfähigkeit einer Stufe der Art { $type } wird nicht abgeschätzt; strength weglassen
gear_train-face-too-narrow-for-contact =
    die Flankenpressung dieser Schrägverzahnung ist nur für Zahnbreiten ab { $least } Moduln bekannt, bei denen die
    Sprungüberdeckung 1 beträgt
gear_train-strength-determines-face = die Tragfähigkeit bestimmt die Zahnbreite; die Zahnbreite oder strength weglassen
gear_train-bevel-without-cones = für diese Kegelräder gibt es bei diesem Winkel keine Teilkegel
gear_train-pinion-not-in-ring =
    das Ritzel läuft nicht im Hohlrad, weil sich Zahnköpfe oder Fußrundungen stören; dem Hohlrad mehr Zähne geben oder
    dem Ritzel weniger
gear_train-direction-without-meaning =
    bei sich schneidenden oder kreuzenden Wellen hat eine Drehrichtung keine Bedeutung: Sie hängt davon ab, auf welcher
    Seite die Räder liegen; nur den Betrag der Übersetzung angeben
gear_train-stages-turn-same =
    mit diesen Stufen drehen An- und Abtrieb gleichsinnig; eine Innenradstufe mehr oder weniger verwenden
gear_train-stages-turn-opposite =
    mit diesen Stufen drehen An- und Abtrieb gegensinnig; eine Innenradstufe mehr oder weniger verwenden
gear_train-ring-in-other-stage = nur eine Stufe der Art internal hat ein Hohlrad; das Feld weglassen
gear_train-ring-too-small =
    das Rad { $gear } ist das Hohlrad und braucht mehr Zähne als sein Ritzel; `ring` angeben, falls das andere Rad das
    Hohlrad ist
gear_train-required-for-type = bei einer Stufe der Art { $type } erforderlich
gear_train-teeth-out-of-range = erwartet werden { $least } bis { $most } Zähne
gear_train-threads-out-of-range = erwartet werden { $least } bis { $most } Gänge
gear_train-too-many-given-pairs =
    mehr als { $limit } Räderpaare für eine Stufe der Art { $type }; die Bereiche verkleinern

# Contradictions between other fields.

gear_train-negative-ratio-same-direction =
    eine negative Übersetzung bedeutet gegensinnige Drehung; das Vorzeichen oder die Drehrichtung weglassen
gear_train-module-and-pitch = der Modul legt die Teilung bereits fest; nur eines von beiden angeben
gear_train-stock-and-teeth = der Vorrat legt die Zähnezahlen bereits fest; teeth oder stock weglassen
gear_train-reverted-single-stage = ein koaxiales Getriebe hat mindestens zwei Stufen; max_stages erhöhen
gear_train-range-count-wrong =
    { $stages ->
        [one] erwartet werden { $ranges } Bereiche, je einer für das treibende und das getriebene Rad von { $stages }
            Stufe; angegeben: { $given }
       *[other] erwartet werden { $ranges } Bereiche, je einer für das treibende und das getriebene Rad von { $stages }
            Stufen; angegeben: { $given }
    }
gear_train-max-undercut = kleiner als { $least }, die kleinste Zähnezahl ohne Unterschnitt; auch min angeben
gear_train-stage-module-repeats = enthält einen Modul doppelt; jeder steht allen Stufen zur Wahl
gear_train-modules-incommensurable = die Moduln haben kein gemeinsames Maß; die Werte runden
gear_train-module-count-wrong =
    { $stages ->
        [one] erwartet wird der Modul von { $stages } Stufe; angegeben: { $given }
       *[other] erwartet werden die Moduln von { $stages } Stufen; angegeben: { $given }
    }
gear_train-range-excludes-gear =
    enthält nicht das Rad { $gear }, das Stufe { $stage } angibt; eines von beiden weglassen
gear_train-modules-and-pitch = { $field } oder modules weglassen
gear_train-modules-repeat = enthält einen Modul doppelt; jeder steht zur Wahl
gear_train-reverted-distance-list = ein koaxiales Getriebe hat einen Achsabstand für alle Stufen; eine Zahl angeben
gear_train-distance-count-wrong =
    { $stages ->
        [one] erwartet wird der Achsabstand von { $stages } Stufe; angegeben: { $given }
       *[other] erwartet werden die Achsabstände von { $stages } Stufen; angegeben: { $given }
    }

# Searches that are too large.

gear_train-too-many-fitted =
    { $count } Zähnezahlen sind angegeben; bei offenem Achsabstand lassen sich höchstens { $limit } paarweise anpassen;
    den Bereich verkleinern oder den Achsabstand angeben
gear_train-too-many-gear-choices =
    { $stages ->
        [one] etwa { $covered } Möglichkeiten für die treibenden oder getriebenen Räder in { $stages } Stufe
            überschreiten die Grenze von { $limit }; weniger Zähnezahlen zulassen
       *[other] etwa { $covered } Möglichkeiten für die treibenden oder getriebenen Räder in { $stages } Stufen
            überschreiten die Grenze von { $limit }; weniger Zähnezahlen oder weniger Stufen zulassen
    }
gear_train-too-many-mesh-combinations =
    { $stages ->
        [one] etwa { $covered } Kombinationen von Eingriffen in { $stages } Stufe überschreiten die Grenze von
            { $limit }; weniger Zähnezahlen zulassen
       *[other] etwa { $covered } Kombinationen von Eingriffen in { $stages } Stufen überschreiten die Grenze von
            { $limit }; weniger Zähnezahlen oder weniger Stufen zulassen
    }

# Progress of the search.

gear_train-listing-gears = Räder werden aufgelistet
gear_train-searching-stages =
    { $stages ->
        [one] { $stages } Stufe: { $trains } Getriebe
       *[other] { $stages } Stufen: { $trains } Getriebe
    }
gear_train-searching-nearest = wenige Getriebe liegen in der Toleranz; die nächsten werden gesucht
gear_train-searching-hunting-teeth = Getriebe mit teilerfremden Zähnezahlen werden gesucht
gear_train-verified = geprüft

# Summary: the best train. $meshes: its pairs of tooth numbers, such as 20:43, 17:58.

gear_train-first-is-undercut = Räder mit { $teeth } Zähnen werden ohne Profilverschiebung von der Zahnstange, die sie schneidet, unterschnitten.
gear_train-best-exact = { $meshes } hat genau die verlangte Übersetzung.
gear_train-best-exact-of-ties =
    { $ties ->
        [one] { $meshes } hat genau die verlangte Übersetzung; kein anderes Getriebe ist ebenso genau.
       *[other] { $meshes } hat genau die verlangte Übersetzung; { $ties } Getriebe sind ebenso genau.
    }
gear_train-best-nearest = { $meshes } hat einen relativen Fehler von { $error }.
gear_train-best-nearest-of-ties =
    { $ties ->
        [one] { $meshes } hat einen relativen Fehler von { $error }; kein anderes Getriebe ist ebenso genau.
       *[other] { $meshes } hat einen relativen Fehler von { $error }; { $ties } Getriebe sind ebenso genau.
    }
gear_train-best-smallest =
    { $meshes } ist das kleinste Getriebe innerhalb von { $tolerance } %, mit einem relativen Fehler von { $error }.

# Summary: the trains that were searched.

gear_train-proven =
    { $count ->
        [one] Bewiesen: Nur { $count } Getriebe hat die gegebenen Zähnezahlen.
       *[other] Bewiesen für alle { $count } Getriebe mit den gegebenen Zähnezahlen.
    }
gear_train-proven-with-given-gears =
    { $count ->
        [one] Bewiesen: Nur { $count } Getriebe hat die gegebenen Zähnezahlen; die von Stufen angegebenen Räder bleiben
            unverändert.
       *[other] Bewiesen für alle { $count } Getriebe mit den gegebenen Zähnezahlen; die von Stufen angegebenen Räder
            bleiben unverändert.
    }
gear_train-best-of-searched =
    { $count ->
        [one] Es ist das einzige Getriebe mit den gegebenen Zähnezahlen.
       *[other] Es ist das beste von allen { $count } Getrieben mit den gegebenen Zähnezahlen.
    }
gear_train-distances-in-steps =
    Zulässige Achsabstände werden in Schritten der Profilverschiebungssumme gesucht; dies ist daher nicht bewiesen.

# Summary without a train. $reason: one of the reasons below.

gear_train-none-verified = Kein Getriebe hat die Prüfung bestanden.
gear_train-none-found = Kein Getriebe gefunden: { $reason }.
gear_train-none-exists = Es gibt kein solches Getriebe: { $reason }.

gear_train-two-stages-turn-same =
    In einem koaxialen Getriebe mit zwei Stufen drehen An- und Abtrieb gleichsinnig; drei Stufen zulassen
gear_train-stock-too-small =
    { $count ->
        [one] Ein Vorrat von { $count } Rad ist für ein solches Getriebe zu klein
       *[other] Ein Vorrat von { $count } Rädern ist für ein solches Getriebe zu klein
    }
gear_train-no-stage-count = Keine Anzahl von Stufen erfüllt die Bedingungen
gear_train-no-stage = Keine zwei Räder bilden eine Stufe, die die Bedingungen erfüllt
gear_train-nearest-too-far =
    Das nächste Getriebe, { $meshes }, hat einen relativen Fehler von { $error }, der die Toleranz überschreitet
gear_train-ratio-unreachable =
    { $stages ->
        [one] Die Übersetzung { $ratio } ist nicht erreichbar; die zulässigen Eingriffe ergeben { $least } bis { $most }
            in { $stages } Stufe
       *[other] Die Übersetzung { $ratio } ist nicht erreichbar; die zulässigen Eingriffe ergeben { $least } bis
            { $most } in { $stages } Stufen
    }
gear_train-no-combination = Keine Kombination von Rädern erfüllt alle Bedingungen
