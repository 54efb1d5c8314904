# Contradictions of the members and the tooth numbers.

planetary_train-unknown-member = erwartet wird eines von { $members }; angegeben: { $member }
planetary_train-member-repeats = { $member } hat bereits eine andere Aufgabe
planetary_train-no-arrangement-fits = keine Bauart hat alle angegebenen Glieder
planetary_train-max-below-min = darf nicht kleiner als min sein
planetary_train-unknown-gear = erwartet wird eines von { $gears }
planetary_train-order-needs-tolerance = Die Reihung nach { $order } braucht eine Toleranz der Übersetzung
planetary_train-ring-diameter-needs-module = braucht einen einzigen Modul; modules weglassen
planetary_train-efficiency-without-strength = wird zusammen mit strength nicht unterstützt
planetary_train-too-many-combinations =
    { $arrangement } hat { $combinations } Kombinationen von Zähnezahlen, mehr als die Grenze von { $limit }; die
    Grenzen enger setzen oder Grenzen für einzelne Räder angeben

# Contradictions of a power and of modules to choose from.

planetary_train-modules-need-power =
    die Wahl zwischen Moduln braucht eine Leistung; strength oder nur einen Modul angeben
planetary_train-module-and-modules = module oder modules weglassen
planetary_train-modules-repeat = enthält einen Modul doppelt; jeder steht zur Wahl
planetary_train-strength-of-bevel-gears = die Tragfähigkeit wird nur für Stirnräder abgeschätzt, nicht für Kegelräder

# Progress of the search. $arrangement: as in the problem.

planetary_train-listing-teeth = { $arrangement }: Zähnezahlen
planetary_train-searching-members = { $arrangement }: { $input } nach { $output }
planetary_train-judging-strength = die Tragfähigkeit der Getriebe wird beurteilt
planetary_train-done = fertig

# Summary. $arrangement: as in the problem. $searched: the combinations searched, and the number of equally exact
# trains if there are several.

planetary_train-best-exact =
    Die Bauart „{ $arrangement ->
        [simple] einfach
        [double_planet] Doppelplaneten
        [stepped] gestuft
        [stepped_suns] gestufte Sonnenräder
        [stepped_rings] gestufte Hohlräder
        [wolfrom] Wolfrom
        [ravigneaux] Ravigneaux
        [two_stage] zweistufig
        [simpson] Simpson
        [bevel_differential] Kegelraddifferenzial
       *[other] { $arrangement }
    }“ erreicht { $ratio } genau; { $searched }.
planetary_train-best-nearest =
    Die Bauart „{ $arrangement ->
        [simple] einfach
        [double_planet] Doppelplaneten
        [stepped] gestuft
        [stepped_suns] gestufte Sonnenräder
        [stepped_rings] gestufte Hohlräder
        [wolfrom] Wolfrom
        [ravigneaux] Ravigneaux
        [two_stage] zweistufig
        [simpson] Simpson
        [bevel_differential] Kegelraddifferenzial
       *[other] { $arrangement }
    }“ erreicht { $ratio } mit einem Fehler von { $error } %; { $searched }.
planetary_train-set-without-effect =
    Bei diesen Gliedern beeinflusst ein Planetensatz die Übersetzung nicht; eine einfachere Bauart wählen.
planetary_train-none-within-limits = Kein Getriebe hält die Grenzen ein: { $searched } ({ $reasons }).
planetary_train-none-permitted = die Grenzen lassen keine zu
planetary_train-none-turns-same =
    Bei diesen Gliedern drehen An- und Abtrieb in keinem Getriebe gleichsinnig; { $searched }.
planetary_train-none-turns-opposite =
    Bei diesen Gliedern drehen An- und Abtrieb in keinem Getriebe gegensinnig; { $searched }.
planetary_train-none-within-tolerance =
    Kein Getriebe liegt innerhalb der Toleranz: { $searched }. Die nächste Übersetzung ist { $ratio }, mit
    { $arrangement } ({ $teeth }; { $input } nach { $output }, { $fixed } fest) und einem Fehler von { $error } %.
planetary_train-none-efficient = Keiner der { $count } Sätze innerhalb der Toleranz hat einen Wirkungsgrad von { $efficiency }; der größte ist { $greatest }.
planetary_train-none-judged-efficient = Keiner der { $count } beurteilten Sätze hat einen Wirkungsgrad von { $efficiency }; der größte ist { $greatest }. Weitere liegen innerhalb der Toleranz.
planetary_train-combinations-searched =
    { $count ->
        [one] { $count } Kombination von Zähnezahlen und Gliedern untersucht
       *[other] { $count } Kombinationen von Zähnezahlen und Gliedern untersucht
    }
planetary_train-ties = { $count } Getriebe haben diesen Fehler
