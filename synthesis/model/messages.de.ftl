# Ranges, intervals and points

model-range-empty = min, max oder beide angeben
model-min-above-max = min darf nicht größer sein als max
model-interval-reversed = das untere Ende muss unter dem oberen liegen
model-point-without-coordinate = mindestens eine Koordinate angeben oder den Punkt weglassen

# Constraints of linkages

model-min-not-below-max = min muss kleiner sein als max
model-full-rotation-excluded =
    der Antrieb eines Getriebes der Klasse { $grashof } kann nicht umlaufen; full_rotation oder grashof weglassen
model-constraint-impossible = { $reason }; die Forderung weglassen
model-manufacture-unsupported =
    nur motion, path und function unterstützen `manufacture`, nicht { $kind }; den Block weglassen
model-rank-by-planes-needs-layout = die Reihung nach planes braucht ein `layout`
model-rank-by-yield-needs-manufacture = die Reihung nach yield braucht `manufacture` mit Toleranzen und einer Qualität
model-space-body-without-positions = nur Aufgaben, die einen Körper durch Lagen führen, haben einen Körper
model-body-frame-without-positions =
    frame body braucht eine Aufgabe, die einen Körper durch Lagen führt; frame weglassen
model-forces-need-dynamics = Kräfte brauchen `dynamics` mit Massen, Lasten und einer Drehzahl
model-joint-force-index-needs-load = der Gelenkkraftindex braucht mindestens eine Last in `dynamics`
model-sliding-input-without-torque =
    den gleitenden Antrieb treibt eine Kraft, kein Moment; stattdessen joint_force oder power begrenzen

# Sixbars

model-sixbars-skipped = Nach Sechsgelenken wurde nicht gesucht, weil sie { $fields } nicht unterstützen.
model-stephenson-2-skipped =
    Nach Stephenson-II-Sechsgelenken wurde nicht gesucht, weil sie { $fields } nicht unterstützen.
model-stephenson-2-without-class =
    grashof klassifiziert das Viergelenk O2 A B O4, das ein Stephenson-II-Sechsgelenk nicht hat
model-sixbars-without-manufacture =
    Getriebe mit mehr als vier Gliedern unterstützen `manufacture` nicht; dieses oder diese Getriebearten weglassen
model-sixbars-without-zones =
    diese Zonen gelten für die Seiten eines Viergelenks; für Getriebe mit mehr Gliedern stattdessen
    constraints.{ $name }_region angeben

# Targets and input motion of given linkages

model-output-target-fields = ein Ziel des Abtriebs besteht aus output und input_angle, ohne x, y und angle
model-target-incomplete = x und y von P angeben, oder output und input_angle
model-speed-twice = die Drehzahl entweder in rad/s oder in Umdrehungen je Minute angeben, nicht beides

# Workspace, zones and layout

model-box-corners-swapped = zuerst die linke untere Ecke angeben, dann die rechte obere
model-position-outside-box = Lage { $position } liegt außerhalb des Rahmens
model-body-near-obstacle = der Körper in Lage { $position } ist diesem Hindernis näher als der Mindestabstand
model-outline-without-area = die Ecken umschließen keine Fläche
model-outline-intersects-itself = der Umriss darf sich nicht selbst schneiden, wie bei x = { $x }, y = { $y }
model-zone-form = ein Polygon oder einen Kreis angeben
model-pin-wider-than-link = pin_diameter darf nicht größer sein als link_width

# Masses, loads and springs

model-materials-need-si = Werkstoffe sind in SI-Einheiten definiert; bei konsistenten Einheiten Dichten angeben
model-sizes-or-layout = { $reason }; oder ein layout angeben, dessen Maße dann gelten
model-speed-missing = speed_rpm angeben, oder speed für einen gleitenden Antrieb; 0 bedeutet Statik
model-prism-needs-sizes = ein Prisma braucht außer seiner Länge width und thickness
model-cylinder-needs-diameter = ein Zylinder braucht außer seiner Länge diameter
model-bore-without-cylinder = nur ein Zylinder hat eine Bohrung; sie muss kleiner sein als sein Durchmesser
model-density-or-material = entweder eine Dichte oder einen Werkstoff angeben
model-width-and-polygon = entweder eine Breite oder ein Polygon angeben, nicht beides
model-shape-empty = eine Breite, ein Polygon oder Teile (parts) angeben
model-plate-needs-thickness = eine Platte mit Breite oder Polygon braucht eine Dicke; Teile haben ihre eigenen Maße
model-holes-without-plate = nur eine Platte kann Löcher haben; eine Breite oder ein Polygon angeben
model-square-ends-without-width = nur ein Stab, der durch eine Breite gegeben ist, kann eckige Enden haben
model-overhang-without-square-ends = nur eckige Enden können überstehen
model-mass-and-shape = entweder die Masseneigenschaften oder eine Form angeben, nicht beides
model-mass-or-shape = eine Masse oder eine Form angeben
model-mass-without-cg = eine Masse braucht ihren Schwerpunkt, `cg`
model-rows-not-increasing =
    die erste Spalte muss von Zeile zu Zeile zunehmen; Zeile { $row } ist nicht größer als Zeile { $previous }
model-table-exceeds-period = die Zeilen umfassen { $span }°, mehr als die { $period }°, nach denen sie sich wiederholen
model-table-ends-differ = die letzte Zeile liegt eine Periode nach der ersten und muss die gleichen Werte haben
model-load-forms = genau eines dieser Felder angeben: { $fields }
model-table-fields-without-table = nur eine Tabelle hat by, interpolation und turns
model-load-needs-place = eine Last wirkt auf ein Glied oder auf ein Gelenk; eines davon nennen
model-load-needs-sort = eine Last ist eine Kraft oder ein Moment; eines davon angeben
model-torque-on-joint = ein Moment wirkt auf ein Glied, nicht auf ein Gelenk
model-load-point-misplaced =
    eine Kraft auf ein Glied braucht einen Punkt; ein Moment und eine Kraft auf ein Gelenk haben keinen
model-load-frame-without-point = nur eine Kraft auf ein Glied kann sich mit ihm drehen
model-force-needs-joint = eine Kraft der Form { $form } braucht ein Gelenk
model-spring-form = entweder die Enden einer Zug- oder Druckfeder angeben oder Federrate und Glieder einer Drehfeder
model-spring-fields-mixed = { $fields }: nur für die andere Art von Feder
model-torsion-spring-needs-links = eine Drehfeder braucht die zwei Glieder, die sie verbindet, `links`

# Manufacture

model-tolerances-zero = mindestens eine Toleranz muss größer als 0 sein
model-quality-needs-dimension-tolerances = eine Qualität braucht Maßtoleranzen: length oder pivot angeben
model-inputs-given-by-task = die Aufgabe gibt die Antriebsstellungen an ihren Zielen vor; fixed verwenden
model-quality-empty = eine Qualität braucht max_error oder max_angle_error
model-quality-only-angles = die Aufgabe hat nur Winkel; stattdessen max_angle_error angeben
model-quality-without-angles = die Aufgabe hat keine Winkel; stattdessen max_error angeben
model-too-many-samples = mit { $targets } Zielen sind höchstens { $samples } Stichproben möglich
model-widest-needs-yield = widest braucht Maßtoleranzen und quality.yield
model-yield-needs-samples = ein Gutanteil von { $share } braucht mindestens { $samples } Stichproben
model-yield-needs-tolerances = fehlt: Ein Gutanteil braucht Toleranzen
model-manufacture-empty = der Block ist leer; tolerances, round oder stock angeben
model-quality-needs-tolerances = fehlt: Eine Qualität braucht Toleranzen

# Gears: ratios, teeth and stages

model-ratio-zero = eine Übersetzung darf nicht null sein
model-ratio-out-of-range = der Betrag einer Übersetzung muss zwischen 1e-9 und 1e9 liegen
model-ratio-text-too-long = höchstens { $count } Zeichen erwartet
model-ratio-division-by-zero = Division durch null
model-ratio-text-ends-early =
    Zahlen, pi, e oder sqrt(Zahl) erwartet, verknüpft durch * oder /, wie 127/50 oder pi/2; hier endet der Text
model-ratio-text-unexpected =
    Zahlen, pi, e oder sqrt(Zahl) erwartet, verknüpft durch * oder /, wie 127/50 oder pi/2; hier steht { $text }
model-max-below-min = darf nicht kleiner sein als min
model-stage-field-foreign = Stufen der Art { $type } haben dieses Feld nicht; es weglassen
model-stage-needs-helix-angle =
    eine schrägverzahnte Stufe braucht den Schrägungswinkel ihres treibenden Rads, ungleich 0
model-bevel-gears-cannot-mesh = Kegelräder mit { $driver } und { $driven } Zähnen können bei diesem Winkel nicht kämmen

# Gears: strength

model-lewis-without-contact-stress =
    die Gleichung von Lewis kennt keine Flankenpressung; das Feld weglassen oder agma verwenden
model-lewis-without-quality = die Gleichung von Lewis kennt keine Qualitätszahl; das Feld weglassen oder agma verwenden
model-lewis-without-factor = die Gleichung von Lewis kennt diesen Faktor nicht; ihn weglassen oder agma verwenden
model-ring-bending-needs-factor = die Biegespannung eines Hohlrads braucht factors/{ $name }; den Wert angeben
model-lewis-only-spur = die Gleichung von Lewis gilt für Geradverzahnungen; für Schrägverzahnungen agma verwenden
model-helix-bending-needs-factor =
    die Biegespannung von Schrägverzahnungen braucht factors/bending_geometry; den Wert angeben
model-allowable-stress-missing = allowable_bending oder allowable_contact angeben, in MPa
model-power-carried-by-all-checked = Es trägt die Leistung nach einer ersten Abschätzung, wie alle geprüften Getriebe.
model-power-carried-after-failures =
    { $count ->
        [one] Es trägt die Leistung nach einer ersten Abschätzung; { $count } besseres Getriebe trägt sie nicht.
       *[other] Es trägt die Leistung nach einer ersten Abschätzung; { $count } bessere Getriebe tragen sie nicht.
    }
model-power-carried-by-no-possible =
    Keines der { $count } möglichen Getriebe trägt { $power } kW mit einer Zahnbreite von { $width } Moduln.
model-power-carried-by-no-best =
    Keines der { $count } besten Getriebe trägt { $power } kW mit einer Zahnbreite von { $width } Moduln.
model-strongest-train = Das stärkste trägt nach einer ersten Abschätzung { $power } kW.
model-further-trains-unchecked = Weitere Getriebe wurden nicht geprüft.
model-strength-estimate =
    Eine erste Abschätzung mit Lehrbuchformeln: Lebensdauer, Temperatur, Schmierung, Einbau und Werkstoffdaten außer den
    angegebenen zulässigen Spannungen bleiben unberücksichtigt. Zahnräder sind nach der geltenden Norm auszulegen.
model-load-sharing-too-large =
    { $planets ->
        [one] bei { $planets } Planetenrad ist der Faktor höchstens { $planets }: Dann trägt eines alles
       *[other] bei { $planets } Planetenrädern ist der Faktor höchstens { $planets }: Dann trägt eines alles
    }
