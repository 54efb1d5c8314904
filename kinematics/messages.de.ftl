# Eine Abmessung, die kein Getriebe haben kann. $name ist ein Feld oder einer der Namen unten, $expected eine der
# Forderungen unten, $value der angegebene Wert.
kinematics-dimension-required = { $name }: gefordert { $expected }, angegeben { $value }

# Forderungen an beliebige Abmessungen, nach „gefordert“.
kinematics-at-least = mindestens { $least }
kinematics-finite = endlich
kinematics-positive = positiv

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
kinematics-between-0-and-pi = zwischen 0 und π
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
