# Bewegung des Antriebs und Umfang der Antwort.
analyses-end-before-start = das Ende darf nicht vor dem Anfang liegen
analyses-step-too-small = mehr als { $most } Stellungen; wählen Sie größere Schritte
analyses-too-many-positions = höchstens { $most } Stellungen mit je { $numbers } Zahlen, angegeben { $positions }

# Kurvengetriebe.
analyses-camshaft-needs-plate-cams = eine Nockenwelle trägt nur Kurvenscheiben; analysieren Sie andere Nocken einzeln
analyses-camshaft-needs-speed = die Welle muss eine positive Drehzahl haben
analyses-camshaft-turns-steadily = die Drehmomente gelten für konstante Drehzahl; lassen Sie die Beschleunigung weg
analyses-neighbouring-points-coincide = benachbarte Punkte müssen verschieden sein
analyses-too-many-points-and-positions = zu viele Punkte und Stellungen; verringern Sie eine der beiden Zahlen
analyses-vibration-needs-speed = für eine Schwingung wird eine positive Drehzahl gebraucht

# Zahnradpaare.
analyses-cutter-needs-ring = nur ein Hohlrad wird mit einem Schneidrad verzahnt; lassen Sie dessen Zähnezahl weg
analyses-cutter-too-large = ein Schneidrad hat weniger Zähne als das Hohlrad, das es verzahnt
analyses-first-gear-without-flank = lässt dem ersten Rad keinen Zahn über dem Grundkreis
analyses-second-gear-without-flank = lässt dem zweiten Rad keinen Zahn über dem Grundkreis
analyses-module-and-pitch = entweder module oder diametral_pitch angeben
analyses-pinion-not-first = geben Sie das Ritzel zuerst an; das Rad hat mindestens ebenso viele Zähne
analyses-ring-not-second = ein Hohlrad hat mehr Zähne als sein Ritzel; geben Sie das Hohlrad an zweiter Stelle an
analyses-second-helix-angle-too-large = das zweite Rad bräuchte einen Schrägungswinkel von { $angle }°

# Standgetriebe: Stufen, Zwischenräder, Reibung. $type ist ein Stufentyp, wie ihn der Client schreibt.
analyses-addendum-needs-ring = nur bei einer Innenradstufe darf die Zahnkopfhöhe von einem Modul abweichen
analyses-distance-of-teeth-differs = aus den Zähnezahlen folgt der Achsabstand { $distance }; lassen Sie ihn weg
analyses-face-reaches-apex = die Zahnbreite muss kleiner sein als die Teilkegellänge dieser Räder, { $distance }
analyses-gear-cannot-drive-worm = bei dieser Reibung kann das Schneckenrad die Schnecke nicht antreiben
analyses-worm-cannot-drive-gear = bei dieser Reibung kann die Schnecke ihr Rad mit keinem Drehmoment antreiben
analyses-output-cannot-drive =
    bei dieser Reibung verliert ein Eingriff die gesamte Leistung, sodass der Abtrieb nicht antreiben kann
analyses-idlers-exclude-shift = eine Stufe mit Zwischenrad hat keine Profilverschiebung
analyses-idlers-need-external-stage = nur eine Stufe des Typs external hat Zwischenräder
analyses-ratio-of-teeth-differs = aus den Zähnezahlen folgt die Übersetzung { $ratio }; lassen Sie ratio weg
analyses-ring-too-small = ein Hohlrad hat mehr Zähne als sein Ritzel
analyses-stage-unknown = diese Stufe gibt es nicht
analyses-stage-without-shift = eine Stufe des Typs { $type } hat keine Profilverschiebung
analyses-thread-count-out-of-range = möglich sind 1 bis { $most } Gänge
analyses-too-few-teeth = gefordert sind mindestens { $least } Zähne
analyses-worm-has-own-loss = der Verlust einer Schnecke folgt aus ihrer eigenen Reibung; lassen Sie den Wirkungsgrad weg

# Schaltgetriebe und Getriebe in Reihe.
analyses-forward-gears =
    { $count ->
        [one] es gibt { $count } Vorwärtsgang
       *[other] es gibt { $count } Vorwärtsgänge
    }
analyses-one-gear-of-pair = geben Sie beide Räder an, oder keines für den direkten Gang
analyses-one-pair-per-stage =
    { $count ->
        [one] für die einzige Stufe ist ein Paar anzugeben
       *[other] für jede der { $count } Stufen ist ein Paar anzugeben
    }
analyses-reverse-gear-missing = es gibt keinen Rückwärtsgang
analyses-stage-has-fewer-pairs =
    { $count ->
        [one] Stufe { $number } hat { $count } Paar
       *[other] Stufe { $number } hat { $count } Paare
    }
analyses-unit-needs-fixed-member = geben Sie das feste Glied der Einheit an
analyses-unit-needs-input = geben Sie das Antriebsglied der Einheit an
analyses-unit-needs-output = geben Sie das Abtriebsglied der Einheit an
analyses-unit-transmits-no-motion = mit diesen Gliedern überträgt das Getriebe keine Bewegung

# Planetengetriebe. $names zählt Namen von Gliedern, Rädern oder Bauarten auf.
analyses-arrangement-and-meshes = geben Sie entweder eine Bauart mit Zähnezahlen oder meshes an, nicht beides
analyses-arrangement-unknown = möglich sind { $names } oder meshes
analyses-drift-needs-input-and-output = geben Sie auch Antrieb und Abtrieb des Getriebes an
analyses-known-speeds-missing = geben Sie bekannte Drehzahlen an, oder Antrieb und festes Glied des Getriebes
analyses-member-unknown = möglich sind die Glieder { $names }
analyses-mesh-of-equal-bodies = die beiden Räder und ihr Steg müssen drei verschiedene Glieder sein
analyses-name-unknown = möglich sind { $names }
analyses-teeth-of-other-gears = erwartet werden Zähnezahlen für { $names }
analyses-speeds-contradict = speeds, torques, powers: die bekannte Drehzahl von { $body } widerspricht den übrigen
analyses-speeds-open =
    { $count ->
        [one] speeds, torques, powers: { $count } Drehzahl ist nicht bestimmt; eine weitere oder das feste Glied angeben
       *[other] speeds, torques, powers: { $count } Drehzahlen sind nicht bestimmt; weitere oder das feste Glied angeben
    }
analyses-torques-of-clutches-unknown = torques, powers, efficiency: das Moment einer Kupplung folgt nicht aus den Drehzahlen
analyses-torques-undetermined =
    torques, powers, efficiency: die gegebenen Momente bestimmen die übrigen nicht; `torques` und `loads` angeben, oder
    `input`, `output` und `fixed` des Getriebes
analyses-efficiency-without-power = efficiency: dem Getriebe wird keine Leistung zugeführt
analyses-ratio-of-resting-output = ratio, exact_ratio: der Abtrieb steht still
analyses-ratio-without-ends = ratio, exact_ratio: `input` und `output` des Getriebes angeben
analyses-motion-of-given-speeds =
    angle, omega, alpha: nur ein `input`, der sich nach `motion` dreht, bewegt die Körper; diese Drehzahlen sind gegeben

# Schalttabelle eines Planetengetriebes.
analyses-brake-or-clutch =
    geben Sie entweder das Glied an, das eine Bremse festhält, oder die beiden Glieder, die eine Kupplung verbindet
analyses-clutch-of-one-member = eine Kupplung muss zwei verschiedene Glieder verbinden
analyses-element-member-unknown = möglich sind die Glieder { $names }
analyses-element-name-repeats = ein anderes Schaltelement hat diesen Namen
analyses-elements-need-table = verlangen Sie auch die Tabelle: "include": ["shift_table"]
analyses-member-named-input =
    ein Glied heißt input: Geben Sie ihm einen anderen Namen, oder geben Sie den Antrieb des Getriebes an
analyses-output-is-input = { $member } ist der Antrieb
analyses-table-needs-input = geben Sie den Antrieb des Getriebes an, oder Kupplungen von der Antriebswelle zu Gliedern
analyses-table-needs-output = geben Sie für die Schalttabelle den Abtrieb des Getriebes an
analyses-too-many-states = { $count } Kombinationen eingelegter Schaltelemente sind mehr als { $most }

# Tragfähigkeit von Zahnrädern.
analyses-bevel-differential-not-rated =
    die Tragfähigkeit eines Kegelraddifferentials wird nicht abgeschätzt, nur die von Stirnrädern
analyses-face-width-missing = geben Sie die Zahnbreite an oder die zulässigen Spannungen, aus denen sie berechnet wird
analyses-helical-ring-not-rated =
    die Tragfähigkeit schrägverzahnter Hohlräder wird nicht abgeschätzt; lassen Sie den Schrägungswinkel weg
analyses-no-power-at-rest = im Stillstand wird keine Leistung übertragen
analyses-one-face-width-per-plane = gefordert { $count }, eine Zahnbreite je Ebene
analyses-stage-not-rated = die Tragfähigkeit einer Stufe des Typs { $type } wird nicht abgeschätzt
analyses-strength-excludes-clutches =
    das Drehmoment einer Kupplung ist unbekannt, sodass sich keine Tragfähigkeit berechnen lässt; lassen Sie strength
    oder die Kupplung weg
analyses-strength-excludes-speeds =
    für die Tragfähigkeit wird die Drehzahl der Bewegung gebraucht; geben Sie stattdessen Antrieb und festes Glied an
analyses-strength-needs-arrangement = geben Sie eine Bauart an; meshes allein legen die Räder nicht fest
analyses-strength-needs-input = geben Sie das Antriebsglied an; es dreht sich mit der Drehzahl der Bewegung
analyses-torque-and-speed-missing =
    geben Sie ein Drehmoment und eine Drehzahl an; ohne sie wird keine Leistung übertragen
analyses-unshifted-gears-not-coaxial =
    nicht profilverschobene Räder mit diesen Zähnezahlen sind nicht koaxial; die Tragfähigkeit wird nur für nicht
    profilverschobene Räder abgeschätzt

# Koppelgetriebe: Aufbau und Antrieb.
analyses-coupler-point-on-pivot = der Koppelpunkt liegt in einem bewegten Gelenk: Seine Kurve ist ein Kreis
analyses-only-fourbar-has-topics = nur für ein Viergelenk mit Drehgelenken gibt es { $topics }
analyses-topics = { $topics } und { $topic }
analyses-link-not-moving = es gibt kein bewegtes Glied dieses Namens; die bewegten Glieder sind { $names }
analyses-shaft-must-drive = ein Schieber treibt dieses Getriebe an; eine Welle muss es antreiben
analyses-slider-speed-as-length =
    ein Schieber treibt dieses Getriebe an; geben Sie seine Geschwindigkeit als `speed` in Längeneinheiten je Sekunde an
analyses-too-many-links-outside-dyads =
    dieses Getriebe hat zu viele Glieder außerhalb von Zweischlägen, um sie gemeinsam zu lösen

# Koppelgetriebe: Hinweise auf fehlende Ergebnisse. Sie beginnen mit Feldnamen, die unverändert bleiben.
analyses-circuits-unknown = circuits, toggles, limits: { $reason }
analyses-too-many-circuits =
    zu viele Zusammenbaulagen oder zu viele Umdrehungen, bis sich die Bewegung wiederholt, um alle Bewegungsbereiche
    aufzuzählen
analyses-limits-at-change-point =
    limits: an einem Wechselpunkt kann sich das Getriebe auf zwei Arten weiterbewegen; die Grenzen sind die des Zweigs der
    Bezugslage
analyses-limits-unknown = limits: die Bezugslage liegt dort, wo mehrere Zweige zusammentreffen, oder auf keinem
analyses-motion-followed-in-part =
    valid: die Glieder sind sehr verschieden lang; die Bewegung wurde bis zur größten Schrittzahl verfolgt, und
    Stellungen dahinter gelten als nicht montierbar, obwohl es sie geben kann
analyses-output-at-rest = { $field }: null, wo der Abtrieb stillsteht (Totlage), bei { $names }
analyses-instant-centers-of-one-position =
    instant_centers: nur für eine einzelne Stellung; diese als `motion.at` angeben
analyses-no-pushing-leg =
    transmission_angle: kein Glied wird von drei Beinen an Antrieb und Gestell getragen, sodass kein Bein auf einer
    eigenen Bahn schiebt; torque_ratio und force_ratio beschreiben die Kraftübertragung
analyses-no-pushing-link =
    transmission_angle: allein Zahnräder treiben jedes Glied an, sodass kein Glied ein anderes schiebt
analyses-pushing-link-undetermined =
    transmission_angle: Bindungen sind überzählig, sodass nicht bestimmt ist, welches Glied schiebt

# Koppelgetriebe: Anordnung in Ebenen.
analyses-layout-not-assembled = das Getriebe lässt sich nicht in der ganzen Bewegung montieren
analyses-layout-range-blocked = das Getriebe kann den genutzten Bereich nicht durchlaufen
analyses-layout-range-too-long = für eine Anordnung höchstens { $most } Grad, von `from` an
analyses-layout-stroke-too-long = für eine Anordnung höchstens { $most } Längeneinheiten, von `from` an

# Koppelgetriebe: Kräfte. $status und $check sind Werte von Feldern.
analyses-flywheel-needs-speed = für ein Schwungrad wird eine Drehzahl gebraucht
analyses-force-check-disagrees = die Prüfung { $check } ergibt eine Abweichung von { $difference }
analyses-force-index-high = joint_force_index: { $index }, größer als { $limit }, bei { $position }
analyses-force-index-infinite = joint_force_index: in einer Totlage unendlich
analyses-status-at-position = { $status } bei { $position }

# Koppelgetriebe: Ziele und Fertigung.
analyses-manufacture-needs-targets = fehlt: Die Untersuchung der Fertigung braucht Ziele
analyses-reference-input-missing =
    fehlt: wird für die Winkel des Körpers gebraucht; geben Sie den Winkel an, oder lassen Sie die Winkel des Körpers
    weg
analyses-targets-need-fourbar-or-slider-crank =
    unterstützt werden nur Viergelenke und Schubkurbeln, die durch ihre Abmessungen gegeben und an der Kurbel
    angetrieben sind
analyses-targets-of-different-forms = hat eine andere Form als das erste Ziel; geben Sie alle Ziele in derselben Form an
analyses-tolerances-missing = fehlt: geben Sie die Fertigungsgenauigkeit des Getriebes an
analyses-yield-not-required = nur Entwürfe können einen geforderten Gutanteil haben; die Antwort enthält den Gutanteil

# Maschinen: Kolbenmotoren, Schwungräder, Malteserkreuzgetriebe, Gesperre, Rotoren, Kreuzgelenke.
analyses-bearings-coincide = zwei Lager an derselben Stelle können kein Kräftepaar aufnehmen
analyses-center-distance-missing = geben Sie den Achsabstand zusammen mit dem Kurbelradius an
analyses-cone-angle-out-of-range = muss mindestens { $least } und kleiner als 90 Grad sein
analyses-crank-radius-out-of-range = muss mindestens { $least } und kleiner als der Achsabstand sein
analyses-drag-link-cannot-turn =
    das Gestell muss das kürzeste Glied sein, und Gestell und längstes Glied müssen zusammen kürzer sein als die beiden
    anderen
analyses-drag-link-needs-plane-drive = eine Doppelkurbel treibt nur ebene Malteserkreuzgetriebe an
analyses-first-joint-offset = vor dem ersten Gelenk ist keine Welle mit Gabeln; lassen Sie den Wert weg
analyses-inner-radius-too-large = muss kleiner als der Außenradius sein
analyses-pawl-too-short = muss größer als die halbe Länge einer Zahnflanke sein
analyses-rod-too-short = das Pleuel muss länger sein als der Kurbelradius
analyses-speed-limit-missing = geben Sie den Ungleichförmigkeitsgrad oder eine kleinste oder größte Übersetzung an
analyses-tooth-too-high = muss kleiner als neun Zehntel des Radradius sein
