### Kurvenscheiben

## Fehler einer Aufgabe. Jeder folgt auf den Namen eines Feldes.

cam-groove-needs-roller = eine Nut kann nur eine Rolle führen; ein Eingriffsglied mit Rolle wählen oder closure `force`
cam-pair-needs-rollers = konjugierte Kurvenscheiben können nur Rollen führen; ein Eingriffsglied mit Rolle wählen oder closure `force`
cam-barrel-has-walls = die Nut einer Trommelkurve hat bereits zwei Wände; ein radiales Eingriffsglied mit Rolle wählen
cam-yoke-has-no-overhang = ein Rahmen um zwei Kurvenscheiben ist auf beiden Seiten geführt; den Überstand weglassen
# Über das Feld max eines Bereichs mit den Feldern min und max.
cam-max-not-above-min = muss über min liegen
cam-spring-range-too-low = die Feder braucht eine Rate von mindestens { $least }, mehr als der angegebene Bereich zulässt
cam-damping-twice = entweder `damping` oder `damping_ratio` angeben
cam-damping-needs-given-spring = braucht eine gegebene `spring_rate`; für eine gewählte Feder `damping_ratio` angeben
cam-train-stiffness-missing = ein Dämpfungsgrad der Kette erfordert `train_stiffness`
cam-max-rpm-below-speed = muss mindestens `speed_rpm` sein
cam-walls-need-no-spring = zwischen zwei Wänden ist keine Feder nötig, die das Eingriffsglied andrückt; eine Rate angeben oder closure `force` wählen
cam-groove-keeps-contact = in einer Nut geht der Kontakt nicht verloren; weglassen
cam-spring-and-motion-unknown = Kraft mal Weg ist nicht konvex, wenn beide unbekannt sind; für die kleinste Kontaktkraft die Federrate angeben, oder die Feder für ein anderes Kriterium oder für gegebene Bewegungsgesetze wählen lassen
cam-contact-force-at-one-speed = Bewegungen mit kleinster Kontaktkraft werden nur für eine Drehzahl gefunden; ein anderes Kriterium wählen oder `max_rpm` weglassen
cam-overhang-needs-dynamics = der Überstand ist der Hebelarm einer Kraft; `dynamics` angeben oder den Überstand weglassen
cam-overhang-too-short = muss größer als der größte Weg sein; sonst läuft die Rolle in die Führung
cam-free-offset-needs-dynamics = eine freie Versetzung ergibt das kleinste Kippmoment; `dynamics` oder die Versetzung angeben
cam-moment-needs-slide = nur ein Stößel auf einer radialen Kurvenscheibe kann kippen; die Grenze weglassen
cam-moment-needs-dynamics = ein Moment hängt von Masse und Feder des Eingriffsglieds ab; `dynamics` angeben
cam-moment-needs-overhang = erforderlich: der Hebelarm des begrenzten Moments
cam-limits-need-free-law = alle Bewegungsgesetze sind gegeben, also liegen ihre Spitzenwerte fest; ein Gesetz auf auto oder optimal setzen oder die Grenze weglassen
cam-contact-force-needs-dynamics = eine Kontaktkraft erfordert Masse und Feder des Eingriffsglieds
cam-groove-has-no-contact-force = in einer Nut drückt keine Kraft das Eingriffsglied an; ein anderes Kriterium wählen
cam-groove-has-no-least-force = in einer Nut wechselt die Rolle die Wand und die Kraft ihr Vorzeichen; `least_force` weglassen
cam-forces-need-speed = Kräfte erfordern die Drehzahl der Kurvenscheibe
cam-least-size-needs-translation = optimale Bewegungen für die kleinste Größe werden nur für Stößel gefunden; ein anderes Kriterium wählen
cam-least-barrel-by-velocity = nach dem Pressungswinkel ist eine Trommelkurve bei der kleinsten Spitzengeschwindigkeit am kleinsten; peak_velocity wählen

## Fehler eines Eingriffsglieds

cam-prime-radius-within-roller = muss größer als der Rollenradius sein
cam-free-offset-needs-free-radius = eine freie Versetzung erfordert einen freien Grundkreisradius; den Grundkreisradius weglassen oder die Versetzung angeben
cam-offset-too-large = muss kleiner als der Grundkreisradius sein
cam-free-pivot-needs-free-radius = ein freier Drehpunkt erfordert einen freien Grundkreisradius; den Grundkreisradius weglassen oder den Drehpunktabstand angeben
cam-arm-does-not-reach = ist mit diesem Hebel und diesem Drehpunktabstand nicht erreichbar
cam-pivot-too-near = muss größer als die Summe von Grundkreisradius und Versatz der Fläche sein

## Fehler in den Abschnitten eines Bewegungsgesetzes

# $motion ist der Wert rise oder fall des Feldes motion eines Abschnitts.
cam-lift-missing = { $motion } erfordert einen Hub
cam-return-from-zero = das Eingriffsglied ist bereits in der Nullstellung; einen Hub angeben
# Über die Felder conditions und bands.
cam-only-for-optimal-motion = nur eine optimale Bewegung kann sie haben
cam-condition-outside-segment = muss innerhalb der { $angle } Grad des Abschnitts liegen
cam-condition-empty = ist leer; s, v, a oder j angeben
cam-conditions-dependent = bestimmen kein eindeutiges Polynom
cam-band-unbounded = hat keine Grenze; lower oder upper angeben
cam-band-end-outside = muss nach start und innerhalb der { $angle } Grad des Abschnitts liegen
cam-band-empty = darf nicht unter lower liegen
cam-follower-rests = das Eingriffsglied bewegt sich nicht; einen Anstieg einfügen
cam-angles-not-one-turn = die Winkel ergeben zusammen { $total } Grad; sie müssen eine Umdrehung ergeben
# $segment und $following sind die Nummern zweier Nachbarn; $motion und $following_motion sind Werte ihres Feldes
# motion. Auf den letzten Abschnitt folgt Abschnitt 0.
cam-displacement-jumps = der Weg springt um { $jump }, wo Abschnitt { $following } ({ $following_motion }) auf Abschnitt { $segment } ({ $motion }) folgt
cam-program-does-not-close = der Weg springt um { $jump }, wo Abschnitt { $following } ({ $following_motion }) auf Abschnitt { $segment } ({ $motion }) folgt; die Bewegung muss enden, wo sie begonnen hat
cam-joint-breaks-fundamental-law =
    { $derivative ->
        [velocity] die Geschwindigkeit
       *[acceleration] die Beschleunigung
    } springt um { $jump }, wo Abschnitt { $following } ({ $following_motion }) auf Abschnitt { $segment } ({ $motion }) folgt; das verletzt das Grundgesetz der Kurvengetriebe; andere Bewegungsgesetze wählen oder accept_discontinuity setzen
cam-joint-needs-edge =
    { $derivative ->
        [velocity] die Geschwindigkeit
       *[acceleration] die Beschleunigung
    } springt um { $jump }, wo Abschnitt { $following } ({ $following_motion }) auf Abschnitt { $segment } ({ $motion }) folgt; die Kurvenscheibe bräuchte dort eine Kante, der kein Eingriffsglied folgen kann; Bewegungsgesetze wählen, die aneinander anschließen
# $law ist ein Wert des Feldes law eines Abschnitts.
cam-law-jumps = die Beschleunigung von { $law } springt; ein anderes Bewegungsgesetz wählen oder accept_discontinuity setzen
cam-motion-jumps = die Bewegung ist dort nicht stetig; siehe accept_discontinuity

## Fortschritt

cam-composing-program = das Bewegungsgesetz wird zusammengesetzt
cam-optimizing-motion = optimale Bewegung: konvexes Programm mit { $steps } Schritten
cam-optimizing-motion-of-several = optimale Bewegung { $number } von { $count }: konvexes Programm mit { $steps } Schritten
cam-trading-sizes = Größe wird nach Pressungswinkel und nach Krümmung abgewogen
cam-sizing = die Kurvenscheibe wird ausgelegt
cam-verifying = Prüfung läuft
cam-verifying-with-points = Prüfung mit { $count } Punkten
cam-verified = geprüft

## Zusammenfassungen

# $circle ist der Kreis, den $radius misst; $unit ist eine Längeneinheit.
cam-follows-program =
    Eine Kurvenscheibe mit einem { $circle ->
        [prime] Grundkreisradius der Rollenmittelpunktsbahn
        [base] Grundkreisradius
       *[cylinder] Zylinderradius
    } von { $radius } { $unit } folgt dem Bewegungsgesetz.
# $limit ist ein Feld von `limits`.
cam-size-set-by-default = Der Radius folgt aus { $limit } { $value }, einer Vorgabe.
# $checks sind Namen von Prüfungen.
cam-fails-checks =
    Die kleinste gefundene Kurvenscheibe mit einem { $circle ->
        [prime] Grundkreisradius der Rollenmittelpunktsbahn
        [base] Grundkreisradius
       *[cylinder] Zylinderradius
    } von { $radius } { $unit } besteht diese Prüfungen nicht: { $checks }.
# $criterion ist ein Wert des Feldes minimize.
cam-is-near-minimum =
    { $criterion ->
        [size] Ihre Größe
        [peak_velocity] Ihre Spitzengeschwindigkeit
        [peak_acceleration] Ihre Spitzenbeschleunigung
        [peak_jerk] Ihr Spitzenruck
        [rms_velocity] Ihr Effektivwert der Geschwindigkeit
        [rms_acceleration] Ihr Effektivwert der Beschleunigung
        [rms_jerk] Ihr Effektivwert des Rucks
        [peak_torque] Ihr Spitzenmoment
        [rms_torque] Ihr Effektivwert des Moments
       *[peak_contact_force] Ihre größte Kontaktkraft
    } liegt höchstens { $gap } % über dem Minimum.
cam-jerk-unbounded = Die Beschleunigung springt; der Ruck hat daher keinen endlichen Spitzenwert, und es wird keiner angegeben.
cam-acceleration-for-instant = Ohne Grenze des Rucks wird eine Beschleunigung womöglich nur für einen Augenblick erreicht; `limits.jerk` setzen.
# $reason ist eine der folgenden Meldungen.
cam-none-exists = Es gibt keine Kurvenscheibe: { $reason }.
cam-none-found = Keine Kurvenscheibe gefunden: { $reason }.

## Gründe, warum es keine Kurvenscheibe gibt

cam-no-law-fits = kein Bewegungsgesetz hält in Abschnitt { $segment } die Grenzen von Geschwindigkeit, Beschleunigung und Ruck ein
cam-no-optimal-motion = innerhalb der Grenzen und Bedingungen wurde keine optimale Bewegung gefunden
cam-motion-limits-too-tight = keine Bewegung hält die Grenzen ein; sie müssen mindestens { $factor }-mal so groß sein
cam-no-size-fits = keine Kurvenscheibe, gleich welcher Größe, folgt dem Bewegungsgesetz innerhalb der Grenzen von Pressungswinkel, Krümmung und Flächenbreite
cam-no-second-size-fits = die zweite der konjugierten Kurvenscheiben hat keine Größe, die die Grenzen von Pressungswinkel und Krümmung einhält
cam-no-cylinder-fits = auf keinem Zylinder hält das Bewegungsgesetz die Grenzen von Pressungswinkel und Krümmung ein
cam-profile-breaks-off = das Profil bricht an einem Sprung des Weges oder der Geschwindigkeit ab; Bewegungsgesetze wählen, die aneinander anschließen
cam-no-contact = das Eingriffsglied kann nicht am Profil anliegen
cam-profile-unresolved = der Kontakt einer Rolle vom Radius { $roller } an einer Kurvenscheibe vom Grundkreisradius { $radius } ist mit der größten Punktzahl je Profil nicht aufzulösen; eine größere Rolle oder eine langsamere Bewegung verwenden
cam-groove-unresolved = der Kontakt einer Rolle vom Radius { $roller } in der Nut eines Zylinders vom Radius { $cylinder } ist mit der größten Punktzahl je Wand nicht aufzulösen; eine größere Rolle oder eine langsamere Bewegung verwenden

## Geltung der Schranke eines Kriteriums: die Bewegungen, für die sie gilt. $scope ist eine andere dieser Meldungen.

cam-scope-named-laws = das beste der benannten Bewegungsgesetze
cam-scope-given-laws = die Bewegungsgesetze sind gegeben
cam-scope-all-motions = alle Bewegungen in den optimalen Abschnitten, bei unveränderten übrigen Abschnitten
# Die vierte Ableitung des Weges heißt hier ping.
cam-scope-below-peak =
    { $scope }, mit { $derivative ->
        [acceleration] einer Spitzenbeschleunigung
        [jerk] einem Spitzenruck
       *[ping] einem Spitzenwert der vierten Ableitung
    } von höchstens { $peak }
cam-scope-without-limits = { $scope }, ohne Grenzen von Beschleunigung und Ruck; mit ihnen liegt das Minimum höher als die Schranke
cam-scope-of-size = { $scope }; die Schranke ergibt sich aus dem Pressungswinkel oder aus Krümmung und Breite einer Fläche

## Warnungen

# Eine oder mehrere der folgenden Meldung, verbunden durch die übernächste, sind $excesses im Satz, der mit
# Großbuchstaben und Punkt geschrieben wird.
cam-peak-high =
    { $derivative ->
        [velocity] die Spitzengeschwindigkeit
        [acceleration] die Spitzenbeschleunigung
       *[jerk] der Spitzenruck
    } ist { $times }-mal
cam-peaks-and-peaks = { $first } und { $second }
cam-peaks-cost = { $excesses } so hoch wie bei einer Zykloidenbewegung mit gleichem Hub und Winkel
cam-peaks-need-limits = { $excesses } so hoch wie bei einer Zykloidenbewegung mit gleichem Hub und Winkel; { $limits } begrenzen
cam-derivative =
    { $derivative ->
        [velocity] Geschwindigkeit
        [acceleration] Beschleunigung
       *[jerk] Ruck
    }
cam-limits-or-limits = { $first } oder { $second }
cam-train-too-soft = die Eigenfrequenz der Kette des Eingriffsglieds beträgt nur das { $ratio }-fache der Drehzahl der Kurvenscheibe (Periode zur Dauer der kürzesten Bewegung: { $periods }); das Eingriffsglied wird schwingen
cam-train-resonates = eine Harmonische der Drehzahl der Kurvenscheibe stimmt mit der Eigenfrequenz der Kette des Eingriffsglieds überein: Resonanz
