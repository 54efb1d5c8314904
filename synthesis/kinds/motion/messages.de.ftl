### Lagensynthese. „Lagen“ sind die Ziellagen des Körpers; eine „Seite“ ist ein Zweischlag des Getriebes (Antrieb oder
### Abtrieb). Fehler stehen hinter dem Namen eines Felds, ohne Punkt am Ende.

# Fortschritt einer Suche.

motion-verified = geprüft
motion-finding-dyads = Zweischläge werden gesucht
motion-finding-sliders = Schieber werden gesucht
motion-finding-links = Glieder werden gesucht
motion-screening-dyad-pairs =
    { $count ->
        [one] { $count } Paar von Zweischlägen wird gesichtet
       *[other] { $count } Paare von Zweischlägen werden gesichtet
    }
motion-screening-slider-pairs =
    { $count ->
        [one] { $count } Paar aus Glied und Schieber wird gesichtet
       *[other] { $count } Paare aus Glied und Schieber werden gesichtet
    }
motion-verifying-best-pairs =
    { $count ->
        [one] das eine gesichtete Paar wird geprüft
       *[other] die besten von { $count } gesichteten Paaren werden geprüft
    }
motion-sampling-poses = Lagen in den Toleranzen werden gezogen
motion-sampling-linkages = Getriebe im Bauraum werden gezogen
motion-fitting-linkages =
    { $count ->
        [one] { $count } Getriebe wird an die Toleranzen angepasst
       *[other] { $count } Getriebe werden an die Toleranzen angepasst
    }
motion-moving-into-workspace =
    { $count ->
        [one] { $count } Getriebe wird in den Bauraum bewegt
       *[other] { $count } Getriebe werden in den Bauraum bewegt
    }
motion-verifying-linkages =
    { $count ->
        [one] { $count } Getriebe wird geprüft
       *[other] { $count } Getriebe werden geprüft
    }
motion-fitting-dyads = einzelne Zweischläge werden angenähert
motion-pairing-dyads = Zweischläge werden gepaart
motion-fitting-pair = Paar { $number } von { $count } wird angenähert
motion-refining-pair = Paar { $number } von { $count } wird verfeinert
motion-verifying-fits = angenäherte Getriebe werden geprüft
motion-sixbars-examined =
    { $count ->
        [one] { $count } Sechsgelenk untersucht
       *[other] { $count } Sechsgelenke untersucht
    }
motion-eightbars-examined =
    { $count ->
        [one] { $count } achtgliedriges Getriebe untersucht
       *[other] { $count } achtgliedrige Getriebe untersucht
    }
motion-verifying-best-eightbars =
    { $count ->
        [one] das eine achtgliedrige Getriebe wird geprüft
       *[other] die besten von { $count } achtgliedrigen Getrieben werden geprüft
    }
motion-verifying-best-sixbars =
    { $count ->
        [one] das eine Sechsgelenk wird geprüft
       *[other] die besten von { $count } Sechsgelenken werden geprüft
    }

# Fehler in den Lagen und ihren Toleranzen.

motion-positions-nearly-equal =
    liegen weniger als { $distance } { $unit } auseinander; eine kleinere Einheit verwenden
motion-position-repeated = gleich der Lage { $position }; die Lagen müssen verschieden sein
motion-tolerance-empty = Toleranz von x, y oder angle angeben; ohne tolerance wird die Lage exakt erfüllt
motion-exact-position-with-tolerance = eine exakte Lage hat keine Toleranz; nur eines von beiden angeben
motion-method-exact-too-many-positions =
    höchstens { $maximum } Lagen lassen sich exakt erfüllen; für mehr Lagen least_squares verwenden
motion-too-many-exact-positions =
    höchstens { $maximum } Lagen lassen sich exakt erfüllen; den anderen eine Toleranz geben
motion-too-few-positions-to-fit =
    least_squares braucht mindestens fünf Lagen; weniger lassen sich exakt erfüllen. Weglassen oder Toleranzen angeben

# Fehler in den Vorgaben für eine Seite (`input_side`, `output_side`) und in der Gestellgeraden.

motion-rotations-need-exact-positions =
    nur für Lagen, die exakt erfüllt werden; die Toleranzen weglassen oder method auf exact setzen
motion-link-angle-needs-exact-position =
    nur mit einer exakten ersten Lage; deren Toleranz weglassen oder method auf exact setzen
motion-not-with-fitted-positions = nicht möglich, wenn Lagen angenähert werden
motion-fitted-vector-incomplete = Länge und Winkel angeben, wenn Lagen angenähert werden
motion-fitted-side-two-pivots = nur einen Gelenkpunkt angeben, wenn Lagen angenähert werden
motion-fitted-pivot-incomplete = beide Koordinaten angeben, wenn Lagen angenähert werden
motion-slider-pivot-incomplete = vom Gelenk eines Schiebers beide Koordinaten angeben
motion-slide-angle-without-slider = gilt nur für Schieber; dyad auf PR oder RP setzen
motion-not-for-dyad = gilt nicht für einen Zweischlag { $dyad }
motion-ground-line-with-slider = nicht zusammen mit einem Schieber möglich
motion-slider-overdetermined =
    { $fixed ->
        [one] legt { $fixed } Zahl fest, doch { $positions } Lagen lassen bei einem Schieber nur { $free } frei
       *[other] legt { $fixed } Zahlen fest, doch { $positions } Lagen lassen bei einem Schieber nur { $free } frei
    }
motion-driver-with-slider = gilt nur für Viergelenke; den Schieber weglassen
motion-driven-block = ein drehbarer Stein kann nicht Antrieb sein; RP auf der Abtriebsseite angeben
motion-two-sliders = nur eine Seite kann einen Schieber haben; die andere braucht Drehgelenke
# Es folgt „; die Bedingung weglassen“.
motion-class-with-slider = gilt nur für Viergelenke; ein Getriebe mit Schieber hat keine Barker-Klasse
motion-rotations-miscounted =
    { $expected ->
        [one] erwartet { $expected } Drehung (eine je weitere Lage), angegeben { $given }
       *[other] erwartet { $expected } Drehungen (eine je weitere Lage), angegeben { $given }
    }
motion-coupler-vector-with-pivot = moving_pivot legt den Koppelvektor schon fest; nur eines von beiden angeben
motion-side-overdetermined =
    legt { $fixed ->
        [one] { $fixed } Zahl
       *[other] { $fixed } Zahlen
    } fest, doch { $positions } Lagen lassen je Seite nur { $free } frei; Angaben weglassen
motion-side-overdetermined-pivot-possible =
    legt { $fixed ->
        [one] { $fixed } Zahl
       *[other] { $fixed } Zahlen
    } fest, doch { $positions } Lagen lassen je Seite nur { $free } frei; Angaben weglassen oder nur einen Gelenkpunkt
    angeben
motion-ground-line-overdetermined =
    legt eine weitere Zahl fest, doch { $positions } Lagen lassen für { $side } nur { $free } frei, und { $fixed }
    { $fixed ->
        [one] ist
       *[other] sind
    } schon vergeben
motion-pivot-outside-region = liegt außerhalb von { $region }
motion-pivot-off-ground-line = liegt nicht auf ground_line
motion-ground-line-parallel =
    ground_line ist parallel zur Richtung der offenen Koordinate; die andere Koordinate angeben
motion-pivots-coincide = gleich { $pivot } der Antriebsseite; einen der beiden Punkte verschieben

# Fehler in `mechanisms` und `chain`.

motion-chain-without-sixbars = gilt nur für Sechsgelenke; in mechanisms nur Sechsgelenke nennen
motion-chain-too-many-positions =
    gilt nur für höchstens { $maximum } Lagen, die exakt oder innerhalb von Toleranzen erfüllt werden; weglassen
motion-chain-type-unsupported =
    gilt nur für die Sechsgelenke Watt I, Stephenson I und Stephenson III; eines davon verlangen oder weglassen
motion-chain-too-short = reicht in Lage { $position } nicht von G bis H₂: Der Abstand ist { $distance } { $unit }
motion-sixbar-too-many-positions =
    für sechs- und achtgliedrige Getriebe sind höchstens { $maximum } Lagen möglich; für mehr Lagen Viergelenke verlangen
motion-not-for-sixbars = gilt nur für Viergelenke; weglassen oder sechs- und achtgliedrige Getriebe aus mechanisms entfernen
motion-not-for-stephenson-2 =
    für Sechsgelenke Stephenson II nicht möglich; weglassen oder andere Getriebearten verlangen
motion-slider-not-listed = eine Seite hat einen Schieber; slider_crank in mechanisms aufnehmen
motion-inverted-slider-not-listable =
    ein Zweischlag RP ergibt eine Kurbelschleife, die keine Liste nennen kann; mechanisms weglassen
motion-fourbar-not-listed = beide Seiten haben Drehgelenke; fourbar in mechanisms aufnehmen

# Fehler in `manufacture`.

motion-manufacture-with-driver = mit einem Antriebszweischlag nicht möglich; eines von beiden weglassen
motion-manufacture-type-unsupported =
    nur für Viergelenke möglich, und für Schubkurbeln mit dem Schieber auf der Abtriebsseite
motion-grid-moves-choice =
    auf einem Raster bleibt { $field } nicht beim angegebenen Wert; eines von beiden weglassen
motion-grid-moves-pivots =
    auf einem Raster bleiben die Gestellpunkte nicht auf ground_line; eines von beiden weglassen

# Namen einer Seite im Genitiv oder Dativ: In den folgenden Meldungen sind sie { $side }.

motion-side = der Seite
motion-input-side = der Antriebsseite
motion-output-side = der Abtriebsseite
motion-side-with-pins = der Seite mit Drehgelenken

# Gründe, aus denen eine Seite keine Zweischläge hat.

motion-straight-translation =
    Die Lagen bilden eine Verschiebung längs einer Geraden: Jeder Punkt des Körpers bewegt sich auf einer Geraden, so
    dass nur ein Schieber ihn führen kann. Es gibt kein Viergelenk mit lauter Drehgelenken.
motion-other-translation =
    Die Lagen bilden eine Verschiebung, die keinem Kreis folgt: Jeder Punkt des Körpers durchläuft die gleichen Punkte
    wie P, so dass kein starres Glied ihn führen kann. Es gibt kein Viergelenk mit lauter Drehgelenken.
motion-rotation-about-point =
    Alle Lagen sind Drehungen um einen Punkt. Er wäre der Gestellpunkt jedes Zweischlags, so dass es kein Viergelenk
    gibt.
motion-nearly-rotation-about-point =
    Alle Lagen sind, soweit ihre Stellen reichen, Drehungen um einen Punkt.
motion-no-pinned-dyad = Kein Zweischlag mit zwei Drehgelenken erfüllt die Lagen und die Vorgaben { $side }.
motion-no-dyad-of-family =
    Eine Schar von Zweischlägen erfüllt die Lagen und die Vorgaben { $side }, doch in Reichweite wurde keiner gefunden.
motion-no-dyad-in-regions =
    Kein Zweischlag { $side } hat seine Gelenke in Reichweite und in den angegebenen Bereichen.
motion-no-dyad-found = Kein gefundener Zweischlag erfüllt die Vorgaben und Bereiche { $side }.
motion-other-pivot-far =
    Das andere Gelenk { $side } wäre etwa { $distance } Aufgabengrößen entfernt; stattdessen einen Schieber verwenden.
motion-negative-length =
    Nur mit einem Glied oder Koppelvektor negativer Länge wären die Vorgaben { $side } erfüllt.
motion-rotations-without-link = Die Drehungen { $side } gehören zu keinem Glied endlicher Länge.
motion-pivot-without-dyad =
    Das angegebene Gelenk { $side } gehört zu keinem Zweischlag, der alle Lagen erfüllt. { $nearest }
motion-no-nearest-pivot = Auch kein anderes Gelenk in Reichweite gehört zu einem solchen Zweischlag.
motion-nearest-pivot = Das nächste Gelenk eines solchen Zweischlags liegt ungefähr bei ({ $x }; { $y }).
motion-pivot-on-line =
    Das angegebene Gelenk { $side } hat alle seine homologen Punkte auf einer Geraden: Nur ein Schieber kann es führen,
    kein Glied mit Drehgelenken. Mit diesen Vorgaben gibt es keinen Entwurf.
motion-pivot-nearly-on-line =
    Das angegebene Gelenk { $side } hat, soweit die Stellen reichen, alle seine homologen Punkte auf einer Geraden.
motion-no-body-point-on-line = Kein Punkt des Körpers hat alle seine homologen Punkte auf einer Geraden.
motion-no-fixed-point-on-line = Kein Punkt des Gestells hat alle seine homologen Punkte auf einer Geraden.

# Bemerkungen zu den Zweischlägen einer Seite.

motion-dyads-meet-other-positions =
    { $positions ->
        [one] Ein Zweischlag, der eine der Lagen erfüllt, erfüllt alle { $total }.
       *[other] Ein Zweischlag, der { $positions } der Lagen erfüllt, erfüllt alle { $total }.
    }
motion-dyads-nearly-meet-other-positions =
    { $positions ->
        [one] Ein Zweischlag, der eine der Lagen erfüllt, erfüllt auf neun Stellen alle { $total }.
       *[other] Ein Zweischlag, der { $positions } der Lagen erfüllt, erfüllt auf neun Stellen alle { $total }.
    }
motion-family-of-dyads = Eine ganze Schar von Zweischlägen erfüllt die Lagen und die Vorgaben { $side }.
motion-dyads-coincide =
    Zweischläge { $side } fallen zusammen (Doppelwurzel) oder liegen zu dicht beieinander, um gezählt zu werden.
motion-dyads-far =
    { $count ->
        [one] { $count } Zweischlag { $side } hat ein Gelenk in mehr als { $distance } Aufgabengrößen Entfernung.
       *[other] { $count } Zweischläge { $side } haben ein Gelenk in mehr als { $distance } Aufgabengrößen Entfernung.
    }
motion-dyads-uncountable =
    Die Lagen und die Vorgaben { $side } lassen zu wenige Stellen übrig, um die Zweischläge zu zählen.
motion-dyads-are-sliders =
    { $count ->
        [one] { $count } weiterer Zweischlag { $side } hat ein Gelenk im Unendlichen, also einen Schieber ({ $kinds }).
       *[other] { $count } weitere Zweischläge { $side } haben ein Gelenk im Unendlichen, also einen Schieber ({ $kinds }).
    }
motion-two-slider-kinds = { $first } und { $second }

# Teile von Zusammenfassungen.

# Steht anstelle der Gründe, aus denen Entwürfe ausgeschieden sind, wenn es keine gibt.
motion-none-rejected = keine
motion-unproven = Das beweist nicht, dass es keinen Entwurf gibt.
motion-no-fourbar-exists = Alle wurden aufgezählt; es gibt also kein Viergelenk.
motion-no-linkage-exists = Alle wurden aufgezählt; es gibt also kein Getriebe.
motion-best-transmission-angle = Bester kleinster Übertragungswinkel: { $angle }°.
motion-best-error =
    Kleinster mittlerer Restfehler (RMS): { $error } % der Aufgabengröße (Winkel in hundertstel Radiant).
motion-better-possible = Ein besseres Getriebe ist möglich.

# Einfache Führungen, vor allen anderen Sätzen einer Zusammenfassung.

motion-hinge-suffices =
    Ein einfaches Drehgelenk genügt: Ein Bolzen bei ({ $x }, { $y }) { $unit } führt den Körper, P im Abstand
    { $radius } { $unit }, durch { $turn }°.
motion-slide-suffices =
    Eine einfache Schiebeführung genügt: Eine Gerade unter { $angle }° durch ({ $x }, { $y }) { $unit } führt den
    Körper, der sich nicht dreht, über { $travel } { $unit }.
motion-parallelogram-suffices =
    Ein Parallelogramm genügt: Zwei parallele Kurbeln von { $length } { $unit } führen den Körper, jede von einem
    beliebigen Punkt des Körpers zu einem Gestellpunkt, der in der ersten Lage um ({ $x }, { $y }) { $unit } davon
    entfernt ist.
motion-guide-misses = Die Lagen werden um höchstens { $distance } { $unit } und { $angle }° verfehlt.

# Zusammenfassungen der Suche nach Viergelenken und Schubkurbeln.

motion-single-dyad = 1 Zweischlag mit zwei Drehgelenken ergibt noch kein Getriebe.
motion-dyads-give-linkages =
    { $dyads } Zweischläge mit zwei Drehgelenken ergeben { $linkages } Getriebe; { $accepted } davon { $accepted ->
        [one] führt
       *[other] führen
    } den Körper durch alle Lagen.
motion-driven-from-either-side =
    { $count ->
        [one] Davon lässt sich { $count } von beiden Seiten antreiben.
       *[other] Davon lassen sich { $count } von beiden Seiten antreiben.
    }
motion-linkages-with-choices =
    { $accepted } von { $linkages } Getrieben mit den angegebenen Vorgaben { $accepted ->
        [one] führt
       *[other] führen
    } den Körper durch alle Lagen.
motion-no-pair-feasible =
    Kein Entwurf gefunden: Jedes der { $candidates } untersuchten Paare von Zweischlägen verletzt eine Bedingung
    (ausgeschieden: { $reasons }). Die Suche ist nicht vollständig; eine Lösung ist noch möglich.
motion-designs-from-pairs =
    { $designs ->
        [one] { $designs } Entwurf
       *[other] { $designs } Entwürfe
    } geprüft, ausgewählt aus { $feasible } brauchbaren Paaren von Zweischlägen ({ $candidates } untersucht).
motion-angle-not-reached = Kein gefundener Entwurf erreicht { $angle }°.
motion-slider-instead-of-pin = Mit einem Schieber anstelle eines Drehgelenks: { $summary }
motion-sliders-found =
    { $count ->
        [one] { $count } Getriebe mit Schieber führt den Körper durch alle Lagen.
       *[other] { $count } Getriebe mit Schieber führen den Körper durch alle Lagen.
    }
motion-slider-cranks-verified =
    { $designs ->
        [one] { $designs } Schubkurbel
       *[other] { $designs } verschiedene Schubkurbeln
    } geprüft, ausgewählt aus { $pairs ->
        [one] { $pairs } Paar
       *[other] { $pairs } Paaren
    } von Zweischlägen.
motion-inverted-slider-cranks-verified =
    { $designs ->
        [one] { $designs } Kurbelschleife
       *[other] { $designs } verschiedene Kurbelschleifen
    } geprüft, ausgewählt aus { $pairs ->
        [one] { $pairs } Paar
       *[other] { $pairs } Paaren
    } von Zweischlägen.
motion-no-slider-crank = Keine gefundene Schubkurbel erfüllt alle Bedingungen (ausgeschieden: { $reasons }).
motion-no-inverted-slider-crank = Keine gefundene Kurbelschleife erfüllt alle Bedingungen (ausgeschieden: { $reasons }).
motion-drivers-added =
    { $accepted } von { $fourbars ->
        [one] { $fourbars } Viergelenk
       *[other] { $fourbars } Viergelenken
    } { $accepted ->
        [one] hat
       *[other] haben
    } einen Antriebszweischlag mit umlaufender Kurbel erhalten.

# Zusammenfassungen von Annäherungen, mit oder ohne Toleranzen.

motion-no-fit-in-workspace =
    Kein Entwurf gefunden: Die Annäherungen von { $starts ->
        [one] { $starts } Startwert
       *[other] { $starts } Startwerten
    } im Bauraum verletzen alle eine Bedingung (ausgeschieden: { $reasons }). Die Suche ist nicht vollständig; eine
    Lösung ist noch möglich.
motion-fits-in-workspace =
    { $fits ->
        [one] { $fits } Entwurf im Bauraum nutzt
       *[other] { $fits } Entwürfe im Bauraum nutzen
    } die Toleranzen, und { $exact ->
        [one] { $exact } Entwurf erfüllt
       *[other] { $exact } Entwürfe erfüllen
    } die Lagen exakt.
motion-no-fit-within-tolerances =
    Kein Entwurf gefunden: Die Annäherungen von { $starts ->
        [one] { $starts } Startwert
       *[other] { $starts } Startwerten
    } innerhalb der Toleranzen verletzen alle eine Bedingung (ausgeschieden: { $reasons }). Die Suche ist nicht
    vollständig; eine Lösung ist noch möglich.
motion-fits-within-tolerances =
    { $fits ->
        [one] { $fits } Entwurf
       *[other] { $fits } Entwürfe
    } aus { $starts ->
        [one] { $starts } Startwert
       *[other] { $starts } Startwerten
    } { $fits ->
        [one] nutzt
       *[other] nutzen
    } die Toleranzen, und { $exact ->
        [one] { $exact } Entwurf erfüllt
       *[other] { $exact } Entwürfe erfüllen
    } die Lagen exakt.
motion-better-pose-possible =
    Die Suche zieht Stichproben von Lagen in den Toleranzen; ein besseres Getriebe ist möglich.
motion-no-linkage-for-sampled-poses =
    Kein Getriebe für { $sets ->
        [one] { $sets } Satz
       *[other] { $sets } Sätze
    } von Lagen, gezogen innerhalb der Toleranzen, erfüllt alle Bedingungen. Die Suche ist nicht vollständig; eine
    Lösung ist noch möglich. Für die exakten Lagen gilt: { $summary }
motion-linkages-for-sampled-poses =
    { $linkages } Getriebe für { $sets ->
        [one] { $sets } Satz
       *[other] { $sets } Sätze
    } von Lagen, gezogen innerhalb der Toleranzen, { $linkages ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
motion-fits-feasible =
    { $passed } von { $candidates ->
        [one] { $candidates } angenäherten Getriebe
       *[other] { $candidates } angenäherten Getrieben
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen der { $positions } Lagen.
motion-no-fit-feasible =
    { $candidates ->
        [one] Das eine angenäherte Getriebe erfüllt nicht alle Bedingungen (ausgeschieden: { $reasons }).
       *[other] Keines von { $candidates } angenäherten Getrieben erfüllt alle Bedingungen (ausgeschieden: { $reasons }).
    }
motion-closer-possible =
    Die Annäherung beginnt an vielen Stellen, ist aber nicht vollständig; ein genaueres Getriebe ist möglich.

# Zusammenfassungen der Suche nach Sechsgelenken. Die ersten vier sind der Anfang eines Satzes, { $effort } in den
# nächsten beiden.

motion-sixbars-fitted =
    { $count ->
        [one] { $count } Sechsgelenk wurde auf einem Zweig an die Lagen angenähert
       *[other] { $count } Sechsgelenke wurden auf einem Zweig an die Lagen angenähert
    }
motion-eightbars-fitted =
    { $count ->
        [one] { $count } achtgliedriges Getriebe wurde auf einem Zweig an die Lagen angenähert
       *[other] { $count } achtgliedrige Getriebe wurden auf einem Zweig an die Lagen angenähert
    }
motion-sixbars-from-chains =
    { $count ->
        [one] { $count } Sechsgelenk aus Ketten mit zwei führenden Kurbeln wurde bewertet
       *[other] { $count } Sechsgelenke aus Ketten mit zwei führenden Kurbeln wurden bewertet
    }
motion-no-sixbar-feasible = { $effort }; kein gefundener Entwurf erfüllt alle Bedingungen.
motion-sixbars-verified =
    { $effort }; { $designs ->
        [one] { $designs } Entwurf geprüft.
       *[other] { $designs } verschiedene Entwürfe geprüft.
    }

# Vergleich der Viergelenke und Schubkurbeln mit Sechsgelenken. { $listing } ist der Rest des Satzes: welche davon
# aufgeführt sind, oder der Punkt.

motion-only-sixbars-feasible =
    Kein gefundenes Viergelenk und keine gefundene Schubkurbel erfüllt alle Bedingungen; Sechsgelenke erfüllen sie.
motion-no-type-feasible =
    Kein gefundenes Viergelenk und keine gefundene Schubkurbel erfüllt alle Bedingungen; auch kein Sechsgelenk.
motion-only-sixbars-transmit =
    Kein gefundenes Viergelenk und keine gefundene Schubkurbel hat einen ausreichenden Übertragungswinkel; Sechsgelenke
    haben einen{ $listing }
motion-sixbars-closer =
    Das beste Viergelenk oder die beste Schubkurbel hat einen mittleren Restfehler (RMS) von { $error } %; Sechsgelenke
    haben höchstens die Hälfte davon{ $listing }
motion-no-sixbar-closer =
    Das beste Viergelenk oder die beste Schubkurbel hat einen mittleren Restfehler (RMS) von { $error } %, und kein
    gefundenes Sechsgelenk erreicht die Hälfte davon.
motion-sixbars-transmit-better =
    Das beste Viergelenk oder die beste Schubkurbel hat einen kleinsten Übertragungswinkel von { $angle }°; Sechsgelenke
    übertreffen ihn{ $listing }
motion-no-sixbar-transmits-better =
    Das beste Viergelenk oder die beste Schubkurbel hat einen kleinsten Übertragungswinkel von { $angle }°, und kein
    gefundenes Sechsgelenk übertrifft ihn.
motion-only-eightbars-feasible =
    Kein gefundenes Getriebe mit weniger Gliedern erfüllt alle Bedingungen; achtgliedrige Getriebe erfüllen sie.
motion-no-eightbar-feasible =
    Kein gefundenes Getriebe mit weniger Gliedern erfüllt alle Bedingungen; auch kein achtgliedriges.
motion-only-eightbars-transmit =
    Kein gefundenes Getriebe mit weniger Gliedern hat einen ausreichenden Übertragungswinkel; achtgliedrige Getriebe
    haben einen{ $listing }
motion-eightbars-closer =
    Das beste Getriebe mit weniger Gliedern hat einen mittleren Restfehler (RMS) von { $error } %; achtgliedrige Getriebe
    haben höchstens die Hälfte davon{ $listing }
motion-no-eightbar-closer =
    Das beste Getriebe mit weniger Gliedern hat einen mittleren Restfehler (RMS) von { $error } %, und kein gefundenes
    achtgliedriges erreicht die Hälfte davon.
motion-eightbars-transmit-better =
    Das beste Getriebe mit weniger Gliedern hat einen kleinsten Übertragungswinkel von { $angle }°; achtgliedrige Getriebe
    übertreffen ihn{ $listing }
motion-no-eightbar-transmits-better =
    Das beste Getriebe mit weniger Gliedern hat einen kleinsten Übertragungswinkel von { $angle }°, und kein gefundenes
    achtgliedriges übertrifft ihn.
motion-only-sixbars-exist = Kein Viergelenk und keine Schubkurbel löst die Aufgabe; Sechsgelenke lösen sie.
motion-simple-types-impossible =
    Kein Viergelenk und keine Schubkurbel löst die Aufgabe, und es wurde kein Sechsgelenk gefunden.
motion-only-sixbars-found = Es wurden kein Viergelenk und keine Schubkurbel gefunden, nur Sechsgelenke.
motion-no-type-found = Es wurden kein Viergelenk, keine Schubkurbel und kein Sechsgelenk gefunden.
motion-only-sixbars-of-requested-types = Von den verlangten Getriebearten wurden nur Sechsgelenke gefunden.
motion-no-requested-type-found = Von den verlangten Getriebearten wurde kein Getriebe gefunden.

## Fortschritt

motion-progress-adding-drivers = Antriebszweischläge werden ergänzt
motion-progress-driving-best-pairs = die besten Paare werden durchgefahren

# Detail of a check

motion-exact-positions-only = Diese Prüfung betrifft { $exact } von { $count } Positionen. Die übrigen sind ausgeglichen: Sie werden um höchstens { $distance } und { $angle }° verfehlt.
