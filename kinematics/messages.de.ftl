# Eine Abmessung, die kein Getriebe haben kann. $name ist ein Feld oder einer der Namen unten, $expected eine der
# Forderungen unten, $value der angegebene Wert.
kinematics-dimension-required = { $name }: gefordert { $expected }, angegeben { $value }

# Namen von Abmessungen.
kinematics-distance-from-slide = Abstand des Gelenks { $joint } von seiner Führung
kinematics-gear-ratio = Übersetzung
kinematics-greatest-ratio = größte Übersetzung
kinematics-input-range = Bereich des Antriebs
kinematics-joint-angle = Winkel eines Gelenks
kinematics-joint-count = Anzahl der Gelenke
kinematics-joint-position = Lage von { $joint }
kinematics-least-ratio = kleinste Übersetzung
kinematics-link-length = Länge von { $link } zwischen { $first } und { $second }
kinematics-part-link = Glied eines Teils
kinematics-part-points = Punkte eines Teils
kinematics-part-radius = Radius eines Teils
kinematics-plates = Platten
kinematics-reference-input = Antriebsstellung der Bezugslage
kinematics-slide = Führung von { $joint }
kinematics-slide-angle = Winkel der Führung von { $joint }
kinematics-stub-shafts = Wellenstümpfe

# Forderungen an beliebige Abmessungen, nach „gefordert“.
kinematics-at-least = mindestens { $least }
kinematics-at-most = höchstens { $most }
kinematics-between-0-and-1 = zwischen 0 und 1
kinematics-count-at-least = eine Anzahl von mindestens { $least }
kinematics-even-and-at-least = gerade und mindestens { $least }
kinematics-finite = endlich
kinematics-from-0-to-1 = von 0 bis 1
kinematics-positive = positiv
kinematics-positive-and-finite = positiv und endlich
kinematics-sign = +1 oder −1
kinematics-zero = null
kinematics-zero-or-more = null oder größer
kinematics-zero-or-more-and-finite = positiv oder null und endlich

# Forderungen an Glieder und ihre Anordnung, nach „gefordert“.
kinematics-arms-reach-rhombus = ein Winkel, bei dem die Arme die Raute erreichen
kinematics-assembly-sign = +1 (offen) oder −1 (gekreuzt)
kinematics-at-most-long = höchstens { $most } lang
kinematics-away-from-moving-pivots = nicht in den Koppelgelenken A und B
kinematics-away-from-toggle = außerhalb einer Totlage
kinematics-bar-and-arm-reach-crank-pin = ein Winkel, bei dem Stange und Arm den Kurbelzapfen erreichen
kinematics-below-right-angle = von 0 bis unter 90°
kinematics-count-of-arrays =
    { $count ->
        [one] { $count } Feld
       *[other] { $count } Felder
    }
kinematics-crank-pin-not-on-pivot = ein Winkel, bei dem der Kurbelzapfen nicht auf O4 liegt
kinematics-derivative-order = 0, 1, 2 oder 3
kinematics-fewer-among-plates =
    weniger bei { $count ->
        [one] { $count } Platte
       *[other] { $count } Platten
    }
kinematics-finite-points = mindestens einer, alle endlich
kinematics-four-on-last-axis = vier auf der letzten Achse
kinematics-fourbar-closes = ein Winkel, bei dem sich das Viergelenk montieren lässt
kinematics-geared-fivebar-closes = ein Winkel, bei dem sich das Fünfgelenk mit Zahnrädern montieren lässt
kinematics-inverted-slider-crank-closes = ein Winkel, bei dem sich die Kurbelschleife montieren lässt
kinematics-link-of-mechanism = ein Glied des Getriebes
kinematics-links-reach-each-other = ein Winkel, bei dem die Glieder einander erreichen
kinematics-longer-than-near = länger als near
kinematics-longest-within-sum = die größte Länge höchstens gleich der Summe der anderen
kinematics-moving-link = ein bewegtes Glied
kinematics-ordered-ends = endlich, vom unteren zum oberen Ende
kinematics-reaches-ram-slide = lang genug, um die Führung des Stößels zu erreichen
kinematics-shorter-than-long-link = kürzer als das lange Glied
kinematics-single-design = ein einzelner Entwurf
kinematics-slider-crank-closes = ein Winkel, bei dem sich die Schubkurbel montieren lässt
kinematics-turning-link = ein Glied, das sich dreht

# Glieder, Führungen und Zahnräder, die kein Getriebe bilden. Namen von Gliedern und Gelenken stehen in
# Anführungszeichen.
kinematics-gear-pair-with-unknown-link =
    ein Zahnradpaar verbindet { $first } und { $second }, aber eines dieser Glieder gibt es nicht
kinematics-gear-without-shaft = das Zahnrad von { $link } hat keine Welle: Dieses Glied ist nicht am Gestell gelagert
kinematics-gears-need-ratio-and-shafts =
    die Zahnräder von { $first } und { $second } brauchen eine Übersetzung ungleich 0 und zwei verschiedene Wellen
kinematics-ground-missing = es fehlt ein Glied mit dem Namen { $link }
kinematics-input-cannot-drive =
    der Antrieb { $input } ist weder ein am Gestell gelagertes Glied noch ein Schieber am Gestell
kinematics-joint-listed-twice = das Glied { $link } nennt ein Gelenk zweimal
kinematics-joint-on-no-link = das Gelenk { $joint } gehört zu keinem Glied
kinematics-joint-without-position = das Glied { $link } nennt das Gelenk { $joint }, dessen Lage fehlt
kinematics-link-apart = das Glied { $link } ist mit den übrigen nicht verbunden
kinematics-link-needs-two-joints = das Glied { $link } braucht mindestens zwei Gelenke
kinematics-links-held-by-slides =
    vom Antrieb führen keine Drehgelenke zu { $links }; nur Schubgelenke halten diese Glieder
kinematics-mobility-above-one =
    gefordert ist der Laufgrad 1, gefunden { $mobility }; suchen Sie ein überzähliges Glied oder Gelenk
kinematics-mobility-at-dead-centre =
    gefordert ist der Laufgrad 1, aus dem Rang der Bindungen folgt { $mobility }; stehen die Glieder in einer Totlage,
    geben Sie eine andere Lage an
kinematics-mobility-below-one =
    gefordert ist der Laufgrad 1, gefunden { $mobility }; suchen Sie ein überzähliges Glied oder Gelenk oder, falls
    Bindungen überzählig sein sollen, Abmessungen, die nicht zusammenpassen
kinematics-mobility-by-rank = gefordert ist der Laufgrad 1, aus dem Rang der Bindungen folgt { $mobility }
kinematics-mobility-in-one-position =
    gefordert ist der Laufgrad 1, gefunden 0: Die Bindungen sind in dieser Lage verträglich, aber in keiner
    benachbarten, die der Antrieb erreichen könnte
kinematics-slide-with-unknown-end =
    eine Führung verbindet das Gelenk { $joint } und das Glied { $link }, aber eines davon gibt es nicht

# Getriebe, deren Bewegung, Bewegungsbereiche oder Kräfte sich nicht bestimmen lassen.
kinematics-circuits-unknown-if-redundant =
    Bindungen sind überzählig; die Bewegungsbereiche sind nur ohne überzählige Bindungen bekannt
kinematics-friction-undetermined-if-redundant = mit überzähligen Bindungen ist die Reibung nicht bestimmt
kinematics-gear-ratio-without-period =
    mit der Übersetzung { $ratio } wiederholt sich die Bewegung nicht innerhalb von { $turns } Umdrehungen
kinematics-geared-needs-dyads =
    ein Getriebe mit Zahnrädern muss sich vom Antrieb aus in Zweischläge zerlegen lassen; dieses lässt sich nicht
    zerlegen
kinematics-gears-turn-link-too-often =
    Zahnräder drehen ein Glied mehr als { $turns }-mal, bevor sich die Bewegung wiederholt; die Bewegungsbereiche sind
    nicht bekannt
kinematics-limits-too-close =
    zwei Grenzlagen liegen zu dicht beieinander, um sie zu trennen; die Bewegungsbereiche sind nicht bekannt
kinematics-link-always-folded =
    { $link } ist bei jeder Antriebsstellung gestreckt oder eingeklappt; die Bewegungsbereiche sind nicht bekannt
kinematics-link-swings-at-standstill = ein Glied bewegt sich frei, während das ersatzweise angetriebene Glied stillsteht
kinematics-link-swings-freely =
    { $link } bewegt sich frei an einem Wechselpunkt, an dem seine Gelenke zusammenfallen, und andere Glieder hängen
    davon ab; die Bewegungsbereiche sind nicht bekannt
kinematics-needs-dyads-and-input-link =
    gefordert ist ein Getriebe, das sich in Zweischläge zerlegen lässt und von einem drehbaren Glied angetrieben wird
kinematics-no-pair-closes-by-dyads =
    mit keinem Paar aus Gestell und Antriebsglied lässt sich dieses Getriebe in Zweischläge zerlegen
kinematics-redundant-needs-dyads =
    ein Getriebe mit überzähligen Bindungen muss sich in Zweischläge zerlegen lassen; dieses lässt sich nicht zerlegen
kinematics-slides-and-gears-need-dyads =
    ein Getriebe mit Führungen oder Zahnrädern muss sich in Zweischläge zerlegen lassen; dieses lässt sich nicht
    zerlegen
# Forderungen an beliebige Abmessungen, nach „gefordert“.

# Namen von Abmessungen der Zahnräder.
kinematics-addendum-and-dedendum = Kopf- und Fußhöhe der Zähne
kinematics-bodies-of-mesh = Körper eines Eingriffs
kinematics-centre-distance = Achsabstand
kinematics-internal-gear = Zähnezahl eines Hohlrads
kinematics-module-and-pressure-angle = Modul und Eingriffswinkel
kinematics-teeth-and-normal-module = teeth und normal_module
kinematics-tip-and-root-radius = Kopf- und Fußkreisradius
kinematics-worm-set = Schneckenradsatz

# Forderungen an Zahnräder und ihre Stufen, nach „gefordert“.
kinematics-above-0-to-1 = größer als 0 und höchstens 1
# $kind: external, internal, helical, bevel oder worm
kinematics-absent-in-stage = keine in einer Stufe der Art { $kind }
kinematics-absent-with-idlers = keine in einer Stufe mit Zwischenrädern
kinematics-at-least-one-stage = mindestens eine
kinematics-base-circles-apart = so groß, dass sich die Grundkreise nicht überschneiden
kinematics-below-worm-lock = kleiner als der Wert, bei dem die Reibung die Schnecke sperrt
kinematics-between-0-and-half-pi = zwischen 0 und π/2
kinematics-between-0-and-pi = zwischen 0 und π
# $bodies: Namen, durch Kommas getrennt
kinematics-body-of-train = einer von { $bodies }
kinematics-cones-not-flat = so gewählt, dass beide Teilkegelwinkel kleiner als 90° sind
kinematics-depth-of-rack-tooth = nicht tiefer als die Spitze des Zahnstangenzahns
kinematics-efficiency-of-meshes = eine Zahl oder { $count } für die Eingriffe
kinematics-external-gear = ein außenverzahntes Rad
kinematics-known-for-every-body = für jeden Körper bekannt
kinematics-less-than-right-angle = kleiner als 90°
# $members: Namen, durch Kommas getrennt
kinematics-load-on-member = an einem der Glieder { $members }
kinematics-more-teeth-than-pinion = größer als die des Ritzels
kinematics-pinion-not-larger = positiv, am Ritzel nicht größer als am Rad
kinematics-positive-numbers = aus positiven Zahlen
kinematics-rising-speeds = positiv, die höchste größer als die niedrigste
kinematics-same-on-both-gears = an beiden Rädern gleich
kinematics-stages-of-gear-pairs = Folgen von mindestens einem Räderpaar
# $gears: Namen, durch Kommas getrennt
kinematics-teeth-of-gears = angegeben für genau { $gears }
kinematics-three-different-bodies = drei verschiedene
kinematics-tooth-bent-by-load = ein Zahn, den seine Last biegt
kinematics-tooth-with-section = ein Zahn mit einem Querschnitt unterhalb seiner Last
# Forderungen an beliebige Abmessungen, nach „gefordert“.

### Kurvenscheiben

# Namen von Abmessungen von Kurvenscheiben und Eingriffsgliedern.
kinematics-base-radius = Grundkreisradius
kinematics-breaks-and-coefficients = Stützstellen und Koeffizienten
kinematics-cam-speeds = Drehzahlen der Kurvenscheiben
kinematics-coefficient-of-fluctuation = Ungleichförmigkeitsgrad
kinematics-contour-under-flat-face = Kontur unter einer ebenen Fläche
kinematics-cylinder-radius = Zylinderradius
kinematics-damping-ratio = Dämpfungsgrad
kinematics-face-offset = Versatz der Fläche
kinematics-first-knot = erster Knoten
kinematics-flank-radius = Flankenradius
kinematics-flat-arm-velocity = Geschwindigkeit des Hebels mit ebener Fläche
kinematics-greatest-rate = größte Federrate
kinematics-half-action-angle = Winkel von der Nase bis zum Ende der Flanke
kinematics-law-parts = Teile des Bewegungsgesetzes
kinematics-nose-distance = Abstand des Nasenmittelpunkts
kinematics-nose-radius = Nasenradius
kinematics-pivot-distance = Drehpunktabstand
kinematics-point-angles = Winkel der Punkte
kinematics-prime-or-base-radius = Grundkreisradius des Eingriffsglieds
kinematics-prime-radius = Grundkreisradius der Rollenmittelpunktsbahn
kinematics-profile-points = Punkte des Profils
kinematics-roller-radius = Rollenradius
kinematics-segment-angle = Winkel eines Abschnitts
kinematics-segment-angles = Summe der Winkel der Abschnitte
kinematics-top-speed = größte Drehzahl
kinematics-wall-points = Punkte der Wand

# Forderungen an Kurvenscheiben und Eingriffsglieder, nach „gefordert“.
kinematics-all-equal = ein gemeinsamer Wert
kinematics-apart-in-angle = Punkte mit verschiedenen Winkeln der Kurvenscheibe
kinematics-arm-closes-triangle = zwischen { $least } und { $most }, damit Hebel und Drehpunktabstand das Dreieck schließen
kinematics-ascending-within-turn = aufsteigend innerhalb einer Umdrehung
kinematics-at-least-rate = mindestens die kleinste Federrate { $rate }
kinematics-at-least-speed = mindestens die Drehzahl { $speed }, die positiv sein muss
kinematics-breaks-ascend = endlich, Stützstellen aufsteigend
kinematics-ccw-or-cw = ccw oder cw
kinematics-condition-in-segment = bei einem Winkel von 0 bis { $angle } und höchstens von der Ordnung { $order }
kinematics-displacement-of-follower = zwischen { $lowest } und { $highest } bei diesem Eingriffsglied
kinematics-distinct-neighbours = endlich und verschieden von ihren Nachbarn
# Grundkreisradius und Versatz der Fläche müssen zusammen kleiner als $most sein, der Drehpunktabstand.
kinematics-face-within-pivot = ein Wert, der mit dem Grundkreisradius zusammen mindestens 0 und kleiner als { $most } ist
kinematics-flank-is-tangent = ein Wert, bei dem die Flanke den Grundkreis und die Nase berührt
kinematics-given-with-points = zusammen mit den Punkten angegeben
kinematics-less-than-1 = kleiner als 1
kinematics-less-than-cam-velocity = kleiner als die der Kurvenscheibe (1 rad/rad)
kinematics-less-than-hollow-radius = kleiner als der Radius der Höhlung, { $radius }
kinematics-less-than-prime-radius = kleiner als der Grundkreisradius { $radius }
kinematics-more-than-roller = größer als der Rollenradius { $radius }
kinematics-no-flanks-in-row = keine zwei Flanken hintereinander, die keine gemeinsame Tangente haben
kinematics-nose-outside-base = größer als { $least }, damit die Nase außerhalb des Grundkreises liegt
kinematics-nowhere-hollow = nirgends hohl
kinematics-one-more-than-rows = eine mehr als die Zeilen der Koeffizienten
kinematics-one-or-more = mindestens eine
kinematics-one-polynomial = Bedingungen, die ein Polynom eindeutig bestimmen
kinematics-one-turn = eine Umdrehung (360 Grad)
kinematics-positive-for-normal = positiv, weil eine Schneide keine Normale bestimmt
kinematics-radius-of-contour = { $radius } bei dieser Kontur
kinematics-shares-of-half = mindestens 0, einer positiv, mit einer Summe von höchstens 1/2
kinematics-swing-sense = 1 oder -1
kinematics-tangent-parts = Teile, die ihre Nachbarn tangential berühren
kinematics-touched-at-every-angle = ein Profil, das das Eingriffsglied bei jedem Winkel der Kurvenscheibe berührt
kinematics-touched-at-points = ein Profil, das das Eingriffsglied bei den Winkeln seiner Punkte berührt
kinematics-within-radius = mindestens 0 und kleiner als der Radius { $radius }
kinematics-zero-or-at-least = 0 oder mindestens { $least }
