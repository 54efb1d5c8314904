# Errors of a rotor

balancing-field-not-for-rotor = bei einem Rotor nicht anwendbar; weglassen
balancing-unbalance-source-choice = die Unwucht genau einmal angeben: durch masses, durch bearing_readings oder durch influence
balancing-reading-speed-missing = Lagerkräfte bestimmen eine Unwucht nur bei bekannter Drehzahl; diese angeben
balancing-grade-needs-field = für die Auswuchtgüte nötig: e ω = U/m ω
balancing-couple-needs-bearings = Unwuchten neben der einzigen Ebene ergeben ein Moment, das an den Lagern zählt; die Lager angeben
balancing-planes-too-close = die zwei Ebenen liegen zu nah beieinander; für eine einzige Ebene einen Ort angeben
balancing-bearings-too-close = die zwei Lager liegen zu nah beieinander
balancing-trial-run-count =
    { $count ->
        [one] { $count } Lauf mit Testmasse erwartet, je Ebene einer
       *[other] { $count } Läufe mit Testmasse erwartet, je Ebene einer
    }
balancing-reading-count-differs =
    { $count ->
        [one] der erste Lauf hat { $count } Messwert
       *[other] der erste Lauf hat { $count } Messwerte
    }
balancing-reading-count-too-small =
    { $count ->
        [one] mindestens { $count } Messwert erwartet, je Ebene einer
       *[other] mindestens { $count } Messwerte erwartet, je Ebene einer
    }
balancing-planes-indistinguishable = die Testmassen ändern die Messwerte gleich oder gar nicht; die Ebenen lassen sich nicht unterscheiden
balancing-hole-step-count = max_per_hole muss 1 bis { $count } Schritte betragen
balancing-correction-choice = genau eines von radius, mass, holes und stock angeben
balancing-stock-is-added = vorrätige Gewichte werden hinzugefügt, nicht weggenommen

# Errors of a linkage

balancing-field-not-for-linkage = bei einem Getriebe nicht anwendbar; weglassen
balancing-linkage-field-required = zum Ausgleich eines Getriebes nötig
balancing-linkage-at-rest = ein ruhendes Getriebe rüttelt nicht; eine Drehzahl angeben
balancing-field-not-for-goal = beim Ziel { $goal } nicht anwendbar; weglassen
balancing-mass-unbounded = unbegrenzt: Mehr Masse verringert das Rütteln immer; die Masse jedes Gewichts oder aller Gewichte begrenzen
balancing-friction-not-supported = die besten Gewichte können nur ohne Reibung berechnet werden; weglassen
balancing-objective-empty = die Zielgröße ist leer: shaking_force, shaking_moment, drive oder joint_forces ein Gewicht geben
balancing-radius-and-mass-given = radius oder mass angeben; das andere folgt daraus
balancing-disc-size-incomplete = eine Scheibe hat eine Dichte und eine Dicke; beide angeben oder keine
balancing-disc-size-missing = eine Scheibe braucht eine Dichte und eine Dicke; beide angeben
balancing-link-named-twice = jedes Glied einmal nennen
balancing-masses-missing = ohne Masse rüttelt nichts; die Massen der Glieder angeben
balancing-not-a-moving-link = kein bewegtes Glied; bewegt sind { $links }
balancing-not-a-joint-of-two-links = kein Gelenk zwischen zwei Gliedern; solche sind { $joints }

# Reasons why gears cannot balance the moment; they follow the colon of no-moment-balance-known

balancing-mass-off-crank-pins = bei { $joint } ist eine Masse; nur die Gelenke zwischen Kurbeln und Koppel dürfen eine tragen
balancing-geared-inertias-for-fourbars = ein Ausgleich durch umlaufende Zahnräder ist nur für Viergelenke mit Drehgelenken bekannt
balancing-coupler-center-off-pin-line = der Schwerpunkt der Koppel liegt nicht auf der Geraden durch ihre Gelenke
balancing-coupler-disc-too-flat = eine Scheibe in der Mitte der Koppel ist zu flach; eine größere Dicke oder Dichte angeben

# Summaries

balancing-none-found = Kein Entwurf gefunden.
balancing-none-exists = Es gibt keinen Entwurf.
balancing-mechanism-not-assembled = Das Getriebe schließt nicht über diese Bewegung.
balancing-balanced-already = Das Getriebe ist bereits ausgeglichen.
balancing-force-balanced = Gegengewichte an { $links } heben die Gestellkraft auf.
balancing-moment-changed = Das Gestellmoment ist { $ratio }-mal so groß wie ohne Gegengewichte.
balancing-weights-on-other-links = Keine Gewichte dieser Größe an { $links } gleichen die Kraft aus; Gewichte an anderen Gliedern tun es.
balancing-links-without-pins =
    { $count ->
        [one] Es gibt keinen Entwurf: Ausgleichen lässt sich ein Getriebe, in dem eine Folge von Drehgelenken von jedem Glied zum Gestell führt; von { $links } führt keine dorthin.
       *[other] Es gibt keinen Entwurf: Ausgleichen lässt sich ein Getriebe, in dem eine Folge von Drehgelenken von jedem Glied zum Gestell führt; von { $links } führen keine dorthin.
    }
balancing-no-weights-balance-force = Es gibt keinen Entwurf: Keine Gewichte an den bewegten Gliedern gleichen die Kraft aus.
balancing-moment-balanced = Weder eine Kraft noch ein Moment rüttelt am Gestell: Die Koppel wirkt wie zwei Massen in ihren Gelenken, und Zahnräder drehen gegen jede Kurbel eine gleich große Trägheit.
balancing-no-moment-balance-known = Ein solcher Ausgleich ist nicht bekannt: { $reason }.

# Summaries of the goal minimize

balancing-objective-reduced = Die Zielgröße sinkt auf { $value }; keine Gegengewichte senken sie unter { $bound }.
balancing-objective-zero-already = Schon ohne Gegengewichte null und daher wegzulassen: { $quantity }.
balancing-joint-force = Gelenkkraft in { $joint }
balancing-joint-forces-undetermined = Gelenkkräfte, die durch überzählige Bindungen nicht bestimmt sind, können weder minimiert noch begrenzt werden; weglassen.
balancing-caps-not-met = Es gibt keinen Entwurf: Die Obergrenzen lassen sich nicht gemeinsam einhalten. Um { $share } % erhöht ließen sie sich einhalten; erreicht wären dann: { $caps }.
balancing-program-not-solved = Kein Entwurf gefunden: Das Programm wurde nicht gelöst.

# Summaries of rotors

balancing-rotor-balanced =
    { $planes ->
        [one] In einer Ebene ausgewuchtet. Die Gestellkraft ist ausgeglichen; Momente aus der Ebene heraus bleiben.
       *[other] In zwei Ebenen ausgewuchtet.
    }
balancing-rotor-balanced-by-places =
    { $planes ->
        [one] In einer Ebene ausgewuchtet, Massen oder Bohrungen: { $places }; Restunwucht { $residual }.
       *[other] In zwei Ebenen ausgewuchtet, Massen oder Bohrungen: { $places }; Restunwucht { $residual }.
    }
balancing-smallest-residual = Die kleinste gefundene Restunwucht beträgt { $residual }; dass es keine kleinere gibt, ist nicht bewiesen.
balancing-smallest-residual-proven = Die kleinste gefundene Restunwucht beträgt { $residual }; für diese Anzahl von Plätzen ist sie bewiesen die kleinste.
balancing-smallest-residual-grade-exceeded = Die kleinste gefundene Restunwucht beträgt { $residual }; dass es keine kleinere gibt, ist nicht bewiesen. Die zugehörige Auswuchtgüte überschreitet die Grenze.
balancing-smallest-residual-proven-grade-exceeded = Die kleinste gefundene Restunwucht beträgt { $residual }; für diese Anzahl von Plätzen ist sie bewiesen die kleinste. Die zugehörige Auswuchtgüte überschreitet die Grenze.
balancing-smallest-grade = Die kleinste gefundene Auswuchtgüte beträgt { $grade } mm/s.

# Progress

balancing-choosing-masses = Massen werden gewählt
balancing-finding-links = Gliedergruppen werden gesucht
balancing-measuring-linkage = das Getriebe wird vermessen
balancing-solving-programs = die konischen Programme werden gelöst
