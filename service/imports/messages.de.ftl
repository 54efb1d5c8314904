## Pictures

imports-contours-too-long = Die Umrisslinien des Bilds haben mehr als { $limit } Punkte, wie die einer Fotografie. Senden Sie eine Zeichnung in zwei Farben.
imports-png-unreadable = Das Bild lässt sich nicht als PNG lesen ({ $error }).
imports-too-many-pixels = Das Bild hat { $width } × { $height } Pixel, mehr als { $limit }.
imports-contrast-too-low = Das Bild hat zu wenig Kontrast; senden Sie dunkle Linien auf hellem Grund oder umgekehrt.

## Tables

imports-table-empty = Die Tabelle hat keine Zeilen.
imports-table-columns = Zeile { $line } der Tabelle hat keine zwei Spalten mit Zahlen.
imports-table-too-long = Die Tabelle hat mehr als { $points } Punkte oder mehr als { $curves } Kurven.
imports-table-without-points = Die Tabelle hat einen Kopf, aber keine Punkte.
imports-foreign-format = Der Inhalt ist weder SVG noch Text-DXF noch PNG noch eine Tabelle mit Punkten.
imports-table-single-column = Die Tabelle hat eine Spalte; sie braucht zwei, x und y.
imports-table-cell-not-number = Zeile { $line } der Tabelle hat eine Zelle, die keine Zahl ist.
imports-table-number-too-large = Zeile { $line } der Tabelle hat eine Zahl jenseits von { $limit }.

## Limits of reading

imports-reading-too-long = Das Lesen der Datei dauert länger als { $seconds } Sekunden; senden Sie eine kleinere oder einfachere.
imports-reading-too-large = Das Lesen der Datei braucht mehr Speicher, als einer Datei hier zusteht; senden Sie eine kleinere oder einfachere.

## Curves

imports-length-zero = seine Länge ist null
imports-curve-too-long = Eine Kurve hat bei der Toleranz { $tolerance } mehr als { $limit } Punkte; geben Sie eine größere an.
imports-no-area = es umschließt keine Fläche
imports-format-or-table-type = Der Inhalt ist weder SVG noch Text-DXF noch PNG; eine Tabelle wird als text/csv gesendet.
imports-shorter-than-gap = es ist nicht länger als die Lücke, über die Enden verbunden werden
imports-few-pixels = es umschließt nur wenige Pixel
imports-coordinates-out-of-range = seine Koordinaten überschreiten { $limit } oder sind keine Zahlen
imports-too-many-points = Die Kurven brauchen zusammen mehr als { $limit } Punkte; geben Sie eine größere Toleranz an.
imports-no-curve = Die Datei hat keine Kurve.
imports-nothing-drawn = Die Datei hat keine Kurve: Sie zeichnet nichts.
imports-smaller-than-listed = es ist kleiner als die { $count } Kurven einer Antwort
