## Formats

outlines-binary-dxf = Der Inhalt ist eine binäre DXF-Datei; speichern Sie sie als Text-DXF (ASCII).
outlines-dwg = Der Inhalt ist eine DWG-Datei; speichern Sie sie als Text-DXF (ASCII).
outlines-compressed = Der Inhalt ist komprimiert; senden Sie die Zeichnung selbst.
outlines-coordinates-out-of-range = seine Koordinaten gehen über { $limit } hinaus oder sind keine Zahlen

## XML and SVG

outlines-transform-unreadable = sein transform lässt sich nicht lesen
outlines-transform-number-count = sein transform hat { $count } Zahlen in { $function }(...)
outlines-path-too-long = Ein Pfad hat mehr als { $limit } Stücke.
outlines-unknown-path-command = es gibt keinen Befehl „{ $command }“, bei Zeichen { $position }
outlines-path-command-missing = bei Zeichen { $position } fehlt ein Befehl
outlines-path-number-missing = bei Zeichen { $position } fehlt eine Zahl
outlines-number-too-large = die Zahl { $number } ist zu groß
outlines-element-is-text = es ist Text; wandeln Sie ihn in Pfade um
outlines-element-is-picture = es ist ein Bild
outlines-element-is-no-shape = es ist keine Form
outlines-too-many-svg-elements = Die Zeichnung hat mehr als { $limit } Elemente, jede Verwendung mitgezählt.
outlines-groups-nested-too-deep = Die Zeichnung schachtelt Gruppen oder Verwendungen tiefer als { $limit } Ebenen.
outlines-use-of-missing-element = es verwendet etwas, das nicht in der Zeichnung ist
outlines-too-many-pieces = Die Zeichnung hat mehr als { $limit } Linien und Kurven.
outlines-root-not-svg = Die Zeichnung ist XML, aber ihr Wurzelelement ist nicht <svg>.
outlines-view-box-unreadable = die Zahlen seiner viewBox lassen sich nicht lesen
outlines-page-view-box-unreadable = Die Zahlen der viewBox der Zeichnung lassen sich nicht lesen.
outlines-page-view-box-invalid = Die viewBox der Zeichnung besteht nicht aus vier Zahlen mit Breite und Höhe.
outlines-view-box-invalid = seine viewBox besteht nicht aus vier Zahlen mit Breite und Höhe
outlines-view-box-without-size = es hat eine viewBox und eine Breite oder Höhe, die von der Seite abhängt
outlines-length-unreadable = sein { $attribute } ist keine Länge oder eine, die von der Seite abhängt
outlines-path-data-wrong = seine Pfaddaten sind falsch: { $reason }
outlines-points-unreadable = die Zahlen seiner Punkte lassen sich nicht lesen
outlines-points-not-pairs = seine Punkte sind keine Zahlenpaare, mindestens zwei
outlines-too-many-elements = Die Zeichnung hat mehr als { $limit } Elemente.
outlines-elements-nested-too-deep = Die Zeichnung schachtelt mehr als { $limit } Elemente ineinander.
outlines-too-many-attributes = Ein Element der Zeichnung hat mehr als { $limit } Attribute.
outlines-xml-entities = Die Zeichnung deklariert XML-Entitäten, die hier nicht aufgelöst werden; speichern Sie sie ohne diese.
outlines-malformed-xml = Die Zeichnung ist kein wohlgeformtes XML: { $reason }.
outlines-unknown-encoding = Die Zeichnung hat eine Kodierung, die hier unbekannt ist; speichern Sie sie als UTF-8.

## DXF

outlines-too-many-entities = Die Zeichnung hat mehr als { $limit } Elemente, jede Einfügung eines Blocks mitgezählt.
outlines-element-is-dxf-text = es ist Text
outlines-entity-without-outline = Elemente seiner Art ergeben keinen Umriss
outlines-entity-incomplete = ihm fehlt, was ein Element seiner Art hat
outlines-blocks-nested-too-deep = Die Zeichnung schachtelt Blöcke tiefer als { $limit } Ebenen.
outlines-block-inserted-too-often = Ein Block wird { $rows } × { $columns }-mal eingefügt, öfter als { $limit }-mal.
outlines-block-missing = es fügt einen Block ein, der nicht in der Zeichnung ist
outlines-dxf-with-nul = Die Zeichnung enthält NUL-Zeichen, die es in Text-DXF nicht gibt.
outlines-dxf-without-eof = Die Zeichnung endet nicht mit EOF; sie ist vielleicht abgeschnitten.
outlines-dxf-unreadable = Die Zeichnung lässt sich nicht als DXF lesen ({ $error }).
outlines-number-unreadable = Eine Zahl der Zeichnung lässt sich nicht lesen.
outlines-number-unreadable-near-line = Eine Zahl der Zeichnung lässt sich nicht lesen, etwa in Zeile { $line }.
outlines-radius-unsuitable = sein Radius ist nicht positiv oder zu groß
outlines-length-zero = es hat keine Länge
outlines-several-parts = es hat mehrere Teile
outlines-too-many-fit-points = es geht durch mehr als { $limit } Punkte
outlines-coordinates-unsuitable = seine Koordinaten sind zu groß oder keine Zahlen
outlines-not-parallel-to-xy = es liegt nicht in einer Ebene parallel zu xy
outlines-blocks-in-blocks = Die Zeichnung hat mehr als { $limit } Blöcke ineinander.
outlines-spline-knots-or-degree = es hat eine Knotenzahl oder einen Grad, den kein Spline hat
outlines-spline-knots-not-ascending = seine Knoten steigen nicht an, oder seine Gewichte sind nicht positiv
outlines-spline-knots-span-nothing = seine Knoten umspannen nichts
outlines-bend-too-sharp = es ist zu stark gekrümmt, um ihm zu folgen

## Outlines

outlines-element-unreadable = es lässt sich nicht lesen
outlines-branching-ends = mehr als zwei offene Elemente treffen dort in einem Punkt zusammen
outlines-open-ends = es ist offen: Seine Enden liegen { $gap } auseinander
outlines-open-chain =
    { $count ->
        [one] es ist offen: Es ist mit { $count } weiteren verbunden, und ihre Enden liegen { $gap } auseinander
       *[other] es ist offen: Es ist mit { $count } weiteren verbunden, und ihre Enden liegen { $gap } auseinander
    }
outlines-foreign-format = Der Inhalt ist weder SVG noch Text-DXF.
outlines-too-many-outlines = Die Zeichnung hat { $count } geschlossene Umrisse, mehr als { $limit }.
outlines-too-many-vertices = Die Umrisse haben bei der Toleranz { $tolerance } zusammen mehr als { $limit } Ecken; geben Sie eine größere an.
outlines-no-area = es umschließt keine Fläche
outlines-too-many-corners = sein Polygon hat { $count } Ecken, mehr als { $limit }; geben Sie eine größere Toleranz an
outlines-meets-itself = es trifft auf sich selbst ({ $place })
outlines-nothing-drawn = Die Zeichnung hat keinen geschlossenen Umriss: Sie zeichnet nichts.
outlines-none-closed =
    { $count ->
        [one] Die Zeichnung hat keinen geschlossenen Umriss; { $count } Element ist keiner, `errors` sagt warum.
       *[other] Die Zeichnung hat keinen geschlossenen Umriss; { $count } Elemente sind keiner, `errors` sagt warum.
    }
