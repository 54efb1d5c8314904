# Errors in the dwells.
dwell-angle-missing = die Länge der Rast mit dwell_angle angeben oder dwells verwenden
dwell-angles-fill-turn = { $count } Rasten von { $angle }° lassen keinen Teil der Umdrehung für die Bewegung
dwell-angle-with-dwells = dwells gibt die Länge jeder Rast an; dies weglassen
dwell-count-with-dwells = dwells bestimmt ihre Anzahl; dies weglassen
dwell-dwells-fill-turn = Rasten von insgesamt { $angle }° lassen keinen Teil der Umdrehung für die Bewegung
dwell-places-too-near = weniger als ein Zehntel des Wegs von Rast { $dwell } entfernt; weiter auseinanderlegen
dwell-places-equal = derselbe Ort wie der von Rast { $dwell }
dwell-places-within-tolerance = innerhalb der Toleranz von Rast { $dwell }; zu einer Rast zusammenfassen
dwell-tolerance-covers-range = nicht kleiner als der Weg des Abtriebs; eine Rast wäre nicht nötig

# Contradictions between mechanism, output and constraints.
dwell-slot-does-not-slide = ein Abtrieb mit Kulisse schwingt; pseudo_arc oder eine Schwinge wählen
dwell-stephenson-does-not-slide = sein Abtrieb schwingt; pseudo_arc, watt_2 oder eine Schwinge wählen
dwell-crank-with-stroke = der Hub bestimmt die Größe; die Kurbel weglassen
dwell-size-lost-in-coordinates = zu klein gegenüber den Koordinaten des Gestellpunkts; den Ursprung näher legen
dwell-crank-rockers-only = die Kurbel läuft um: Gesucht werden nur Kurbelschwingen
dwell-turning-cranks-only = die Kurbel läuft um: Gesucht werden nur Kurbelschwingen und Doppelkurbeln

# Progress; a type is one of the names below.
dwell-driving-random-sixbars = zufällige Sechsgelenke werden durchgefahren ({ $type })
dwell-driving-outputs = Abtriebe auf Koppelkurven werden durchgefahren ({ $type })
dwell-refining = { $next } von höchstens { $all } wird verfeinert
dwell-verified = geprüft

# Names of types.
dwell-pseudo-arc = Pseudobogen
dwell-straight-slot = gerade Kulisse
dwell-watt-2 = Watt II
dwell-stephenson-2 = Stephenson II

# Methods.
dwell-method-from-curves =
    zufällige Koppelkurven mit Abtrieben an ihren Bögen und Geraden, sequenzielle lineare Optimierung
dwell-method-from-random-sixbars = zufällige Sechsgelenke, sequenzielle lineare Optimierung

# Quantities.
dwell-angle = { $angle }°
dwell-angle-and-angle = { $first } und { $last }
dwell-length = { $length } { $unit }

# Summaries.
dwell-sixbars-found =
    { $count ->
        [one] { $count } Rastgetriebe
       *[other] { $count } Rastgetriebe
    } gefunden. Im ersten bewegt sich der Abtrieb während der Rast um höchstens { $movement } und bleibt über { $angles } der Kurbel innerhalb von { $tolerance }.
dwell-sixbars-found-stillest =
    { $count ->
        [one] { $count } Rastgetriebe
       *[other] { $count } Rastgetriebe
    } gefunden. Im ruhigsten bewegt sich der Abtrieb während der Rast um höchstens { $movement } und bleibt über { $angles } der Kurbel innerhalb von { $tolerance }.
dwell-none-found =
    Es wurde kein Rastgetriebe gefunden, das alle Bedingungen erfüllt ({ $reasons }). Dennoch kann es eines geben.
dwell-none-rests = keines kommt zur Ruhe
dwell-longest-dwells = Die längsten gefundenen Rasten sind { $angles }.
