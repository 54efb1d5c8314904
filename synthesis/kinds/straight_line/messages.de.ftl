### Geradführungen: Ein Punkt eines Getriebes läuft auf einer gegebenen Geraden. Die Arten von Getrieben heißen nach
### ihren Erfindern. Fehler stehen hinter dem Namen eines Felds, ohne Punkt am Ende.

# Fortschritt einer Suche und ihr Verfahren.

straight_line-searching-type = Getriebe { $mechanism } werden gesucht
straight_line-verified = geprüft
straight_line-method =
    sequentielle lineare Optimierung in jeder Familie; exakte Geradführungen nach ihren Abmessungen

# Fehler in der Aufgabe.

straight_line-crank-range-too-large =
    die Kurbel von { $mechanism } dreht sich um weniger als { $limit }°; einen kleineren Winkel angeben oder ein anderes
    Getriebe wählen
straight_line-length-too-short =
    zu kurz gegenüber den Koordinaten des Anfangspunkts; den Nullpunkt näher heranlegen
# Es folgt „; die Bedingung weglassen“.
straight_line-class-of-exact-mechanism = gilt für Viergelenke; ein Getriebe { $mechanism } hat keine Klasse

# Zusammenfassung.

straight_line-none-found =
    Es wurde keine Geradführung gefunden, die alle Bedingungen erfüllt ({ $reasons }). Es kann noch eine geben.
straight_line-mechanisms-found =
    { $count ->
        [one] { $count } Geradführung gefunden.
       *[other] { $count } Geradführungen gefunden.
    }
straight_line-runs-on-slide = Der Lenker nach Scott-Russell läuft selbst auf einer geraden Führung.
straight_line-first-is-exact =
    Die erste, nach { $mechanism }, folgt der Geraden genau; ihre Geschwindigkeit schwankt um { $variation } %.
straight_line-first-stays-in-strip =
    Die erste, nach { $mechanism }, bleibt in einem Streifen von { $width } % der Länge; ihre Geschwindigkeit schwankt
    um { $variation } %.
