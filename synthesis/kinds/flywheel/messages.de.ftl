# Errors of the statement

flywheel-torque-source-choice = genau eines von torque und machine angeben
flywheel-units-differ = das Rad ist in Einheiten { $units } angegeben; die Maschine in denselben Einheiten angeben
flywheel-mass-unbounded = unbegrenzt: Die Masse sinkt mit wachsendem Radius; radius, rim_speed oder radius_to_thickness begrenzen oder die kleinste Dicke (bei einem Kranz zusammen mit der kleinsten Wand)
flywheel-wall-unbounded = unbegrenzt: Ein Kranz wird mit dünnerer Wand leichter; die größte Dicke oder die Wand begrenzen
flywheel-disc-has-no-wall = eine Scheibe hat keine Wand; einen Kranz wählen oder die Grenze weglassen

# Reasons why a torque is unknown; they follow the colon of torque-unknown

flywheel-motion-not-repeating = das Getriebe und seine Lasten wiederholen sich nicht innerhalb weniger Umdrehungen
flywheel-forces-unknown = die Kräfte des Getriebes sind nicht über das ganze Arbeitsspiel bekannt: { $status } bei { $angle }°
flywheel-torque-not-repeating = das Moment des Getriebes wiederholt sich nach einem Arbeitsspiel nicht

# Summaries

flywheel-torque-unknown = Kein Schwungrad gefunden: { $reason }.
flywheel-energy = Die Energie schwankt über ein Arbeitsspiel um { $energy }.
flywheel-mean-torque-negative = Das mittlere Moment ist negativ: Im Mittel treibt die andere Seite die Welle.
flywheel-not-needed = Es ist kein Schwungrad nötig: Die Welle hält den Ungleichförmigkeitsgrad ohne eines ein.
flywheel-lightest-wheel =
    { $form ->
        [disc] Das leichteste Rad ist eine Scheibe mit der Masse { $mass } und dem Trägheitsmoment { $inertia }. Maßgebende Grenzen: { $limits }.
       *[rim] Das leichteste Rad ist ein Kranz mit der Masse { $mass } und dem Trägheitsmoment { $inertia }. Maßgebende Grenzen: { $limits }.
    }
flywheel-form-does-not-fit =
    { $form ->
        [disc] Keine Scheibe mit dem erforderlichen Trägheitsmoment passt in die Grenzen.
       *[rim] Kein Kranz mit dem erforderlichen Trägheitsmoment passt in die Grenzen.
    }

# Progress

flywheel-computing-torque = Moment über ein Arbeitsspiel
flywheel-sizing = Auslegung läuft
flywheel-integrating-speed = die Drehzahl wird integriert
