### Lenkung eines Fahrzeugs mit zwei Achsschenkeln: Ackermanns Lenktrapez und Davis' Lenkung.
### Fehler stehen hinter dem Namen eines Felds, ohne Punkt am Ende.

# Fortschritt einer Suche.

steering-fitting-ackermann = Ackermanns Lenkung wird angenähert
steering-verifying = Prüfung läuft
steering-verified = geprüft

# Fehler in der Aufgabe.

steering-track-too-small =
    die Räder lägen zwischen den Achsschenkelbolzen; die Spurweite ist größer als deren Abstand
steering-arms-too-long =
    Lenkhebel, die halb so lang wie der Abstand der Achsschenkelbolzen sind, können sich berühren; kürzere angeben
steering-full-rotation =
    eine Lenkung geht von Einschlag zu Einschlag und läuft nicht um; diese Bedingung weglassen
steering-toggle-between-locks =
    eine Lenkung, die zwischen ihren Einschlägen eine Totlage durchläuft, lenkt nicht; hier true lassen
# Auf die nächsten beiden folgt „; die Bedingung weglassen“.
steering-class-of-davis = Davis' Lenkung hat Schieber und keine Klasse der Viergelenke
steering-class-of-ackermann = Ackermanns Lenktrapez hat zwei gleiche Lenkhebel und erfüllt die Grashof-Bedingung nie

# Zusammenfassung.

steering-best-error =
    { $count ->
        [one] Das beste von { $count } Lenktrapez nach Ackermann hat einen Lenkfehler von { $error }°.
       *[other] Das beste von { $count } Lenktrapezen nach Ackermann hat einen Lenkfehler von { $error }°.
    }
steering-inside-wheels-first = Zuerst stehen Lenktrapeze, deren Spurstange innerhalb der Räder bleibt.
steering-davis-is-exact = Davis' Lenkung lenkt bei jedem Winkel richtig.
steering-none-exists = Es gibt keinen Entwurf.
steering-none-found = Es wurde kein Entwurf gefunden.
steering-lock-out-of-reach = Kein Lenktrapez nach Ackermann mit solchen Lenkhebeln erreicht den Einschlag.
