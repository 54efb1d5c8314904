# Errors in the points and their timing.
path-angle-with-free-timing = die Zuordnung ist frei; "timing": "prescribed" angeben oder dies weglassen
path-prescribed-timing-only = gilt nur bei vorgeschriebener Zuordnung; die Zuordnung ist frei
path-angle-missing = die Zuordnung ist vorgeschrieben; einen Winkel angeben
path-too-few-angles = eine vorgeschriebene Zuordnung braucht mindestens drei verschiedene Kurbelwinkel
path-angles-repeat = gleich dem von Punkt { $point }; exakte Punkte brauchen verschiedene Winkel
path-angles-out-of-order =
    die Kurbelwinkel folgen nicht innerhalb einer Umdrehung aufeinander; die Punkte umordnen oder "in_order": false
    angeben
path-too-few-points-differ =
    { $count ->
        [one] alle sind gleich; mindestens drei müssen verschieden sein
       *[other] nur { $count } davon sind verschieden; es müssen mindestens drei sein
    }
path-points-all-equal = alle gleich; die Punkte müssen verschieden sein
path-points-repeat = gleich Punkt { $point }; die Punkte müssen verschieden sein
path-tolerance-missing = fehlt, obwohl andere Punkte eine haben; für alle Punkte angeben oder für keinen
path-exact-points-with-tolerances =
    exakt getroffene Punkte haben keine; mit least_squares annähern oder die Toleranzen weglassen

# Contradictions between method, timing and constraints.
path-too-many-points =
    mit freier Zuordnung lassen sich hier höchstens { $count } Punkte exakt treffen; sie mit least_squares annähern
path-too-many-points-with-timing =
    mit vorgeschriebener Zuordnung lassen sich hier höchstens { $count } Punkte exakt treffen; sie mit least_squares
    annähern
path-free-place-for-matched-fourbars = gilt nur für curve_match mit Viergelenken; weglassen
path-matched-curve-with-timing = eine als Ganzes angenäherte Kurve hat keine Zuordnung; sie freilassen
path-fixed-pivots-equal = die Gestellpunkte müssen verschieden sein
path-pivot-outside-region = außerhalb des Bereichs, in dem er liegen muss
path-class-does-not-turn =
    eine geschlossene Kurve braucht einen umlaufenden Antrieb; der eines Getriebes der Klasse { $grashof } läuft nicht
    um
path-manufacture-not-for-fivebars = unterstützt Viergelenke und Schubkurbeln, keine Räderkoppel-Fünfgelenke
path-manufacture-not-for-free-place = unterstützt keine Kurven mit freier Lage; placement_free weglassen

# Requests that a type of mechanism does not support. Types are named by the client's values, such as slider_crank.
path-mechanism-without-gears = { $mechanism } hat keine Zahnräder
path-output-does-not-turn = mit einem Abtrieb, der nicht dreht, ist es ein Viergelenk; dieses anfordern
path-gears-do-not-repeat =
    die Zahnräder kehren innerhalb von { $turns } Umdrehungen nicht in ihre Stellung zurück; ein Verhältnis kleiner
    ganzer Zahlen angeben
path-timing-for-fourbars-only =
    nur Viergelenke unterstützen eine vorgeschriebene Zuordnung; sie für { $mechanism } freilassen
path-mechanism-without-class = teilt Viergelenke ein; { $mechanism } hat keine Klasse
path-coupler-point-for-fourbars-only =
    begrenzt die Lage von P auf der Koppel eines Viergelenks; für { $mechanism } weglassen
path-slider-crank-with-output-pivot = eine Schubkurbel hat nur einen Gestellpunkt, den der Kurbel
path-types-named-twice = mechanisms nennt bereits alle Getriebearten; dies weglassen
path-types-without-gears = keine der verlangten Getriebearten hat Zahnräder
path-not-for-sixbars =
    gilt nicht für Sechsgelenke und achtgliedrige Getriebe; weglassen oder diese aus mechanisms entfernen
path-turning-sixbars-only =
    gesucht werden nur Sechsgelenke und achtgliedrige Getriebe mit umlaufender Kurbel
path-stance-not-for-stephenson =
    wird für Sechsgelenke nach Stephenson II nicht unterstützt; andere nennen oder weglassen

# Errors in a stance.
path-stance-point-unknown = es gibt { $count } Punkte, ab 0 gezählt
path-stance-of-one-point = eine Standphase braucht zwei verschiedene Punkte
path-stance-wraps-around = eine offene Bahn geht hinter ihrem letzten Punkt nicht weiter; die beiden Punkte vertauschen
path-stance-points-coincide = die beiden Punkte fallen zusammen und bestimmen keine Gerade
path-stance-without-limits = begrenzt nichts; die Ebenheit oder eine konstante Geschwindigkeit angeben
path-stance-speed-is-free = gilt für eine konstante Geschwindigkeit; "speed": "constant" angeben
path-stance-on-exact-points = exakte Punkte lassen einer Standphase keine Freiheit; sie annähern
path-stance-with-timing = eine Standphase braucht eine freie Zuordnung; sie bestimmt, wie sich P mit dem Antrieb bewegt
path-stance-with-free-place = eine Standphase liegt, wo sie gezeichnet ist; dies weglassen
path-stance-out-of-order = eine Standphase durchläuft ihre Punkte der Reihe nach

# Errors in a start: a fourbar from which a fit begins.
path-start-for-least-squares-only = ein Startgetriebe gilt nur für least_squares; diese Methode wählen
path-start-with-timing = ein Startgetriebe gilt für Punkte mit freier Zuordnung
path-start-is-no-fourbar = ein Startgetriebe muss ein Viergelenk sein
path-start-with-stance = ein Startgetriebe gilt nur für Annäherungen an Punkte allein; eines von beiden weglassen
path-start-link-without-length = ein Glied hat keine Länge; seine beiden Gelenke müssen verschieden sein

# Progress.
path-verified = geprüft
path-linkages-verified = { $done } von { $all } Getrieben geprüft
path-linkages-driven = { $done } von { $all } Getrieben durchgefahren
path-real-linkages-verified = { $done } von { $all } reellen Getrieben geprüft
path-linkages-perturbed = { $number } Getriebe verändert und neu angenähert
path-eightbars-driven = { $done } von { $all } achtgliedrigen Getrieben durchgefahren
path-sixbars-driven = { $done } von { $all } Sechsgelenken durchgefahren
path-driving-linkages = Getriebe { $next } von { $all } wird durchgefahren
path-following-paths = { $count } Pfade
path-paths-followed = { $done } von { $count } Pfaden verfolgt
path-round = Runde { $round } von { $rounds }: { $progress }
path-round-found =
    { $count ->
        [one] Runde { $round } von { $rounds }: { $count } Getriebe geht durch alle Punkte
       *[other] Runde { $round } von { $rounds }: { $count } Getriebe gehen durch alle Punkte
    }
path-computing-dyads = alle Zweischläge werden berechnet
path-linkages-compared = { $done } von { $count } Getrieben verglichen
path-best-shapes-refined = beste Formen verfeinert
path-fitting-with-angle = Annäherung mit einem Übertragungswinkel von { $angle }°
path-fitting-stance = Standphase wird angenähert
path-refining-fits = Annäherungen werden verfeinert
path-fitting-class = Klasse { $number } von { $count }: Annäherung von Zufallswerten aus
path-perturbing-fits = die besten Annäherungen werden abgewandelt
path-shapes-compared = Formen der Getriebe verglichen
path-linkages-fitted =
    { $count ->
        [one] { $count } Getriebe angenähert
       *[other] { $count } Getriebe angenähert
    }
path-eightbars-fitted =
    Runde { $round }: { $compared } achtgliedrige Getriebe verglichen, { $fitted } angenähert
path-sixbars-fitted = Runde { $round }: { $compared } Sechsgelenke verglichen, { $fitted } angenähert

# Summaries of exact searches.
path-five-points-with-timing =
    { $inputs ->
        [one] { $inputs } Antriebszweischlag
       *[other] { $inputs } Antriebszweischläge
    } und { $fourbars ->
        [one] { $fourbars } Viergelenk
       *[other] { $fourbars } Viergelenke
    } gehen bei ihren Kurbelwinkeln durch die fünf Punkte; { $passed ->
        [one] { $passed } davon erfüllt
       *[other] { $passed } davon erfüllen
    } alle Bedingungen.
path-dyads-with-slider =
    { $count ->
        [one] { $count } weiterer Zweischlag hat
       *[other] { $count } weitere Zweischläge haben
    } ein Gelenk im Unendlichen (einen Schieber).
path-family-with-timing =
    { $passed } von { $count ->
        [one] { $count } Getriebe
       *[other] { $count } Getrieben
    }, die bei ihren Kurbelwinkeln durch die { $points } Punkte gehen, { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
    Die Punkte lassen Freiheit; die Getriebe sind Stichproben daraus.
path-family-fitted =
    { $starts ->
        [one] { $starts } Startgetriebe nahe einer Kurve durch die Punkte wurde
       *[other] { $starts } Startgetriebe nahe einer Kurve durch die Punkte wurden
    } angenähert; { $reached ->
        [one] { $reached } erreichte
       *[other] { $reached } erreichten
    } alle Punkte exakt, mit den verlangten Gestellpunkten.
path-distinct-linkages-passed =
    { $passed } von { $count } verschiedenen Getrieben { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-solutions-on-pivots =
    { $computed } von { $count } Lösungen auf diesen Gestellpunkten wurden berechnet; { $real ->
        [one] { $real } ist reell
       *[other] { $real } sind reell
    },
    { $on_one_circuit ->
        [one] { $on_one_circuit } davon hat
       *[other] { $on_one_circuit } davon haben
    } alle Punkte in einem Bewegungsbereich, und { $passed ->
        [one] { $passed } erfüllt
       *[other] { $passed } erfüllen
    } alle Bedingungen.
path-triples-computed =
    { $computed } von { $count } Tripeln von Ersatzgetrieben wurden berechnet; { $real ->
        [one] { $real } ist reell
       *[other] { $real } sind reell
    },
    { $on_one_circuit ->
        [one] { $on_one_circuit } davon hat
       *[other] { $on_one_circuit } davon haben
    } alle Punkte in einem Bewegungsbereich, und { $passed } von { $designs ->
        [one] { $designs } Entwurf
       *[other] { $designs } Entwürfen
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-others-may-exist = Es kann weitere geben.
path-no-fourbar-does-both = Das sind alle Viergelenke; keines davon leistet beides.
path-no-design-exists = Das sind alle Viergelenke; einen Entwurf gibt es also nicht.
path-none-found = Es wurde keines gefunden; dennoch kann es welche geben.
path-none-exact-so-fitted =
    Kein Getriebe der Art { $type } trifft die Punkte exakt und erfüllt alle Bedingungen; die Punkte werden stattdessen
    angenähert. { $fits } Exakte Suche: { $exact }
path-none-exact-found-so-fitted =
    Es wurde kein Getriebe der Art { $type } gefunden, das die Punkte exakt trifft und alle Bedingungen erfüllt; die
    Punkte werden stattdessen angenähert. { $fits } Exakte Suche: { $exact }
path-fits-miss-points =
    Die beste Annäherung nach kleinsten Quadraten verfehlt einen Punkt um { $miss } { $unit }, mehr als { $share } % der
    Größe der Aufgabe; solche Entwürfe liefert die Methode least_squares.

# Summaries of fits to points.
path-fits-passed =
    { $passed } von { $count ->
        [one] { $count } angenäherten Getriebe
       *[other] { $count } angenäherten Getrieben
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-best-fit-with-timing =
    Das beste durchläuft die { $points } Punkte bei ihren Kurbelwinkeln mit einem mittleren Abstand (RMS) von
    { $rms_distance } { $unit } und einem größten von { $max_distance } { $unit } (Quadratsumme { $sum_of_squares }
    { $unit }²).
path-best-fit-in-order =
    Das beste durchläuft die { $points } Punkte der Reihe nach mit einem mittleren Abstand (RMS) von { $rms_distance }
    { $unit } und einem größten von { $max_distance } { $unit } (Quadratsumme { $sum_of_squares } { $unit }²).
path-curve-strays = Zwischen den gegebenen Punkten weicht die Kurve um bis zu { $excursion } { $unit } ab.
path-fits-far-between-points =
    { $count ->
        [one] { $count } weiteres liegt
       *[other] { $count } weitere liegen
    } nahe an den Punkten, aber zwischen ihnen weit von deren Verlauf entfernt.
path-no-fit-passed =
    { $count ->
        [one] Das einzige angenäherte Getriebe erfüllt nicht alle Bedingungen
       *[other] Keines der { $count } angenäherten Getriebe erfüllt alle Bedingungen
    } (ausgeschieden: { $reasons }).
path-no-fits = Kein Getriebe ließ sich den Punkten annähern.
path-descended-from-given-start =
    Die kleinsten Quadrate wurden vom gegebenen Startgetriebe aus gesucht; anderswo kann es ein näheres Getriebe geben.
path-descended-from-many-starts =
    Die kleinsten Quadrate wurden von vielen Startgetrieben aus gesucht; es kann ein näheres Getriebe geben, das von
    keinem aus erreicht wird.

# Summaries of whole curves and of stances.
path-curve-fitted-on-pivots =
    Getriebe auf den gegebenen Gestellpunkten wurden von vielen Startgetrieben aus an Punkte längs der Kurve angenähert.
path-some-passed =
    { $passed } von { $count } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-curves-compared =
    { $curves } Kurven von { $linkages ->
        [one] { $linkages } Getriebe
       *[other] { $linkages } Getrieben
    } wurden mit dem Ziel verglichen und { $refined } davon verfeinert.
path-designs-and-cognates-passed =
    { $passed } von { $count } Entwürfen, Ersatzgetriebe eingeschlossen, { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-best-curve =
    Der beste zeichnet die Kurve mit einem mittleren Abstand (RMS) von { $rms_distance } { $unit } und einem größten
    Abstand von { $max_distance }.
path-cognates-ranked =
    Ersatzgetriebe zeichnen dieselbe Kurve; an erster Stelle steht das mit Gestellpunkten nahe der Kurve, guter
    Kraftübertragung und ausgeglichenen Gliedlängen.
path-flattest-stance = Die ebenste Standphase liegt in einem Streifen von { $flatness } { $unit }.
path-flattest-and-most-even-stance =
    Die ebenste Standphase liegt in einem Streifen von { $flatness } { $unit }; die gleichmäßigste Geschwindigkeit
    bleibt innerhalb von { $deviation } % ihres Mittels.

# Summaries of other types. A type is one of the names below, or several of them joined by path-type-or-type.
path-slider-cranks-passed =
    { $passed } von { $count ->
        [one] { $count } angenäherten Schubkurbel
       *[other] { $count } angenäherten Schubkurbeln
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-geared-fivebars-passed =
    { $passed } von { $count ->
        [one] { $count } angenäherten Räderkoppel-Fünfgelenk
       *[other] { $count } angenäherten Räderkoppel-Fünfgelenken
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-sixbars-passed =
    { $passed } von { $count ->
        [one] { $count } angenäherten Sechsgelenk
       *[other] { $count } angenäherten Sechsgelenken
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-eightbars-passed =
    { $passed } von { $count ->
        [one] { $count } angenäherten achtgliedrigen Getriebe
       *[other] { $count } angenäherten achtgliedrigen Getrieben
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
path-no-linkage-fitted = Keines der gezogenen Getriebe ließ sich innerhalb der Bedingungen annähern.
path-best-distance = Der mittlere Abstand (RMS) des besten beträgt { $rms_distance } { $unit }.
path-best-sixbar-exact = Das beste Sechsgelenk ist ein { $type } mit P auf { $link }, das die Punkte trifft.
path-best-sixbar =
    Das beste Sechsgelenk ist ein { $type } mit P auf { $link }; sein mittlerer Abstand (RMS) beträgt { $rms_distance }
    { $unit }.
path-best-sixbar-both-ways =
    Das beste Sechsgelenk ist ein { $type } mit P auf { $link }; sein mittlerer Abstand (RMS) beträgt { $rms_distance }
    { $unit }, in beiden Richtungen gemessen { $both_way_rms }.
path-best-eightbar-exact = Das beste achtgliedrige Getriebe, mit P auf { $link }, trifft die Punkte.
path-best-eightbar =
    Das beste achtgliedrige Getriebe hat P auf { $link }; sein mittlerer Abstand (RMS) beträgt { $rms_distance }
    { $unit }.
path-best-eightbar-both-ways =
    Das beste achtgliedrige Getriebe hat P auf { $link }; sein mittlerer Abstand (RMS) beträgt { $rms_distance }
    { $unit }, in beiden Richtungen gemessen { $both_way_rms }.
path-only-other-passed =
    Kein gefundenes Getriebe der Art { $simple } erfüllt alle Bedingungen, wohl aber solche der Art { $other }.
path-neither-passed =
    Weder ein Getriebe der Art { $simple } noch eines der Art { $other } wurde gefunden, das alle Bedingungen erfüllt.

# Without a full stop: a remark on the listed designs follows, as in "; they are not listed ...".
path-only-other-sound =
    Kein gefundenes Getriebe der Art { $simple } ist brauchbar; brauchbare der Art { $other } wurden gefunden
path-other-halves-error =
    Der Fehler des besten Getriebes der Art { $simple } beträgt { $error } { $unit }; Getriebe der Art { $other } haben
    höchstens die Hälfte davon

# Comparisons of types that end the summary.
path-neither-sound = Weder ein gefundenes Getriebe der Art { $simple } noch eines der Art { $other } ist brauchbar.
path-no-other-halves-error =
    Der Fehler des besten Getriebes der Art { $simple } beträgt { $error } { $unit }; kein gefundenes Getriebe der Art
    { $other } hat höchstens die Hälfte davon.

# Names of types. None of them may be a message with a value that equals its text.
path-fourbar = Viergelenk
path-slider-crank = Schubkurbel
path-geared-fivebar = Räderkoppel-Fünfgelenk
path-sixbar = Sechsgelenk
path-eightbar = achtgliedriges Getriebe
path-type-or-type = { $first } oder { $last }
path-sixbar-name =
    { $type ->
        [watt_1] Sechsgelenk nach Watt I
        [stephenson_1] Sechsgelenk nach Stephenson I
        [stephenson_2] Sechsgelenk nach Stephenson II
       *[stephenson_3] Sechsgelenk nach Stephenson III
    }

# Cognates. The sentences about a cognate begin with path-left-cognate or path-right-cognate.
path-no-cognates =
    P liegt auf einem Gelenkpunkt; seine Bahn ist ein Kreis oder Kreisbogen, und es gibt keine Ersatzgetriebe.
path-transmission-of-linkage = Der kleinste Übertragungswinkel dieses Getriebes beträgt { $angle }°.
path-transmission-of-type = Der kleinste Übertragungswinkel dieses Getriebes ({ $type }) beträgt { $angle }°.
path-left-cognate =
    Das linke Ersatzgetriebe ({ $type } auf den Gestellpunkten ({ $input_x }; { $input_y }) und ({ $output_x };
    { $output_y }))
path-right-cognate =
    Das rechte Ersatzgetriebe ({ $type } auf den Gestellpunkten ({ $input_x }; { $input_y }) und ({ $output_x };
    { $output_y }))
path-cognate-passes-toggle =
    { $cognate } durchläuft zwischen den Punkten eine Totlage, wenn es an seinem Antrieb bewegt wird.
path-cognate-out-of-order =
    { $cognate } erreicht die Punkte nicht der Reihe nach, wenn sein Antrieb in einer Richtung dreht.
path-cognate-with-same-timing =
    { $cognate } führt P bei denselben Kurbelwinkeln durch die Punkte;
    sein kleinster Übertragungswinkel ist { $comparison ->
        [larger] größer
        [smaller] kleiner
       *[equal] gleich
    }: { $angle }°.
path-cognate-with-other-timing =
    { $cognate } führt P durch die Punkte, wobei sein Antrieb mit der Koppel dieses Getriebes dreht;
    sein kleinster Übertragungswinkel ist { $comparison ->
        [larger] größer
        [smaller] kleiner
       *[equal] gleich
    }: { $angle }°.

# Names of the motions of fourbars.
path-double-crank = Doppelkurbel
path-crank-rocker = Kurbelschwinge
path-rocker-crank = Kurbelschwinge mit Antrieb an der Schwinge
path-double-rocker = Doppelschwinge
path-rocker-rocker = nicht umlauffähige Doppelschwinge
path-change-point = durchschlagendes Viergelenk
