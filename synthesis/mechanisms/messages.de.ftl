# Dimensions of given mechanisms

mechanisms-pivots-give-other-distance = die Gestellpunkte ergeben { $length }; das Feld weglassen oder berichtigen
mechanisms-not-assembled-at-angle = das Getriebe lässt sich bei diesem Antriebswinkel nicht zusammenbauen
mechanisms-not-assembled-at-any-angle =
    das Getriebe lässt sich mit diesen Längen bei keinem Antriebswinkel zusammenbauen
mechanisms-slide-gives-other-offset = Schieber und Gestellpunkt ergeben { $length }; das Feld weglassen oder berichtigen
mechanisms-coupler-point-undirected = fehlt: Es legt die Richtung des Koppelpunkts fest
mechanisms-coupler-point-on-pivot = das Kurbelgelenk liegt auf O4; der Koppelpunkt hat keine Richtung
mechanisms-quick-return-crank-length =
    eine schwingende Kurbelschleife (crank_shaper) braucht eine Kurbel, die kürzer ist als das Gestell, ein
    Whitworth-Getriebe eine längere
mechanisms-fixed-pivots-coincide = beide Gestellpunkte fallen zusammen; sie müssen verschieden sein

# Skeletons

mechanisms-link-names-equal = die Namen der Glieder müssen verschieden sein
mechanisms-skeleton-link-has-other-lengths =
    im Skelett hat das Glied { $link } Gelenke in den Abständen { $lengths }; das Feld weglassen oder berichtigen
mechanisms-skeleton-has-other-lengths =
    das Skelett hat ein Glied mit Gelenken in den Abständen { $lengths }; das Feld weglassen oder berichtigen
mechanisms-ground-without-joint = das Gestell des Skeletts hat dort kein Gelenk
mechanisms-skeleton-lacks-joint = das Skelett hat kein Gelenk { $joint }
mechanisms-skeleton-has-other-point = das Skelett hat einen anderen Punkt P; das Feld weglassen oder berichtigen
mechanisms-angle-with-driving-slide = ein Schieber treibt dieses Getriebe an; das Feld weglassen
mechanisms-skeleton-has-other-angle =
    das Antriebsglied des Skeletts hat einen anderen Winkel; das Feld weglassen oder berichtigen
mechanisms-skeleton-contradicts-dimensions =
    { $first } und { $second } haben den Abstand { $distance }; die Maße ergeben { $expected }

# Given cams

mechanisms-needed-by-translating-roller = ein Rollenstößel braucht diese Angabe
mechanisms-needed-by-oscillating-roller = ein Schwinghebel mit Rolle braucht diese Angabe
mechanisms-needed-by-oscillating-flat = ein Schwinghebel mit Fläche braucht diese Angabe
mechanisms-zero-displacement-undefined = wird gebraucht, um den Hub null festzulegen
mechanisms-as-many-values-as-x = ebenso viele Werte erwartet wie in x
mechanisms-neighbouring-points-equal = benachbarte Punkte müssen verschieden sein
mechanisms-groove-needs-roller = nur eine Rolle läuft in einer Nut
mechanisms-flank-radius-or-angle = entweder dieses Feld oder den halben Arbeitswinkel angeben

# Masses, loads, springs and friction

mechanisms-unknown-moving-link = kein bewegtes Glied; bewegt sind { $links }
mechanisms-unknown-joint = kein Gelenk des Getriebes; Gelenke sind { $joints }
mechanisms-joint-of-other-link = kein Gelenk von { $link }
mechanisms-ends-without-bar = nur ein Stab mit zwei Gelenken hat Enden
mechanisms-friction-with-redundancy =
    Bindungen sind überzählig, sodass die Kräfte, die Reibung verursachen, nicht eindeutig sind
mechanisms-friction-without-rotation = dort dreht sich nichts; Drehgelenke sind { $pins }
mechanisms-unknown-slide = das Getriebe hat { $count } Schieber, gezählt ab 0
mechanisms-index-needs-load = der Gelenkkraftindex braucht mindestens eine Last
mechanisms-index-with-redundancy = Bindungen sind überzählig, sodass die Gelenkkräfte des Index nicht eindeutig sind
mechanisms-flywheel-with-driving-slide =
    ein Schwungrad braucht eine Antriebswelle; ein Schieber treibt dieses Getriebe an
mechanisms-unknown-link = kein Glied; Glieder sind { $links }
mechanisms-spring-on-one-link = eine Feder wirkt zwischen zwei Gliedern; hier liegen beide Enden auf { $link }
mechanisms-torque-with-driving-slider = ein Schieber treibt dieses Getriebe an; das Feld weglassen
mechanisms-other-slide-drives = der antreibende Schieber ist { $slide }
mechanisms-input-link-drives = ein Moment am Antriebsglied treibt dieses Getriebe an
mechanisms-impossible-inertia = bodies: { $link } hat ein Trägheitsmoment, das kein Körper dieser Masse und Länge hat
mechanisms-massless-links = bodies: ohne Masse sind { $links }
mechanisms-spring-without-direction =
    beide Enden fallen in der Bezugsstellung zusammen, sodass die Kraft keine Richtung hat
mechanisms-torsion-spring-not-followed = die Drehung der Drehfeder lässt sich nicht verfolgen: { $reason }
mechanisms-plate-without-area = die Platte hat keine Fläche; das Polygon ist flach, oder die Löcher sind zu groß
mechanisms-hole-beyond-edge = das Loch reicht über den Rand der Platte hinaus
mechanisms-slide-drives = ein Schieber treibt dieses Getriebe an
mechanisms-link-drives = der Winkel eines Glieds treibt dieses Getriebe an
mechanisms-slide-not-periodic = der Ort eines Schiebers ist nicht periodisch; linear verwenden
mechanisms-slide-does-not-turn = ein Schieber dreht sich nicht
mechanisms-table-period-unknown = die Zahl der Umdrehungen angeben, nach denen sich die Tabelle wiederholt: { $reason }
mechanisms-gas-with-driving-slide =
    Gasdruck braucht einen von einer Kurbel bewegten Kolben; ein Schieber treibt dieses Getriebe an
mechanisms-gas-without-full-turn =
    Gasdruck braucht einen von einer Kurbel bewegten Kolben; der Antrieb kann nicht umlaufen
mechanisms-gas-without-piston = Gas wirkt auf einen Kolben; das Gelenk { $joint } gleitet nicht auf dem Gestell
