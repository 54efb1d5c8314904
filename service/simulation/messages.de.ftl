## PMKS+

simulation-pmks-without-gears = PMKS+ unterstützt keine Zahnräder.
simulation-pmks-equal-joints = Zwei Glieder dieses Entwurfs haben dieselben Gelenke; PMKS+ benennt Glieder nach ihnen.
simulation-pmks-too-many-joints = Dieser Entwurf hat mehr als { $limit } Gelenke; PMKS+ benennt Gelenke mit einzelnen Buchstaben.

## Options and motion

simulation-design-dynamics-invalid = `dynamics` des Entwurfs ist ungültig: { $reason }.
simulation-unused-with-sliding-input = Das hat bei einem gleitenden Antrieb keine Bedeutung; lassen Sie es weg.
simulation-unused-with-turning-input = Das hat bei einem drehenden Antrieb keine Bedeutung; lassen Sie es weg.
simulation-not-verified-over-motion = Dieser Entwurf wurde nicht über eine Bewegung geprüft; es gibt daher nichts zu simulieren.
simulation-input-at-rest = Der Antrieb dieses Entwurfs bewegt sich in seiner geprüften Bewegung nicht.
simulation-speed-too-small = Eine Simulation braucht eine Geschwindigkeit vom Betrag { $least } oder mehr.

## Models

simulation-coordinates-too-large = Koordinaten dieses Entwurfs oder ihre Änderungsraten überschreiten 1e9, die Grenze für MuJoCo.
simulation-built-larger = { $factor }-mal größer als der Entwurf gebaut: Seine Körper wären für MuJoCo zu leicht.
simulation-bodies-too-light = Die Körper dieses Entwurfs sind für MuJoCo zu leicht: { $lightest } kg oder kg m², weniger als { $least }.
simulation-does-not-assemble = Die Abmessungen dieses Entwurfs ergeben keinen montierbaren Mechanismus.
simulation-cannot-be-driven = Dieser Entwurf lässt sich nicht antreiben: { $reason }.
simulation-unused-with-linkage = Das hat bei einem Koppelgetriebe keine Bedeutung; lassen Sie es weg.
simulation-redundant-constraints = Die Zwangsbedingungen dieses Entwurfs sind redundant: Die Gleichungen in Modelica wären singulär. Verwenden Sie stattdessen .mjcf mit MuJoCo.

## Linkages: bodies and masses

simulation-passes-toggle = Der Entwurf lässt sich nicht durch seine ganze Bewegung antreiben: Sie enthält eine Totlage.
simulation-block = Gleitstein bei { $joint }
simulation-no-mass = Kein bewegtes Glied hat Masse.
simulation-negligible-masses = Körper ohne Masse oder Trägheit, denen ein Millionstel der Werte des schwersten gegeben wurde: { $bodies }.
simulation-dynamics-not-in-si = `dynamics` der Aufgabe hat eigene Einheiten, Simulationen jedoch SI-Einheiten; geben Sie es mit `units: si` an.
simulation-dynamics-field-does-not-fit = `dynamics` der Aufgabe passt nicht zu diesem Entwurf: { $place }: { $reason }.
simulation-dynamics-does-not-fit = `dynamics` der Aufgabe passt nicht zu diesem Entwurf: { $reason }.
simulation-dynamics-not-included = Nicht enthalten: { $fields } aus `dynamics` der Aufgabe.
simulation-scale-with-masses = `dynamics` der Aufgabe gibt die Massen der Glieder an: Lassen Sie `scale` weg.
simulation-masses-of-problem = Massen und Schwerkraft sind die aus `dynamics` der Aufgabe.
simulation-links-as-plates = Die Glieder sind Platten aus { $material } ({ $density } kg/m³), { $width } m breit mit runden Enden und { $thickness } m dick; ihre Bohrungen sind mit Bolzen gefüllt.
simulation-gravity-of-problem = Die Schwerkraft ist die aus `dynamics` der Aufgabe.
simulation-no-gravity = Es gibt keine Schwerkraft.

## Gear trains

simulation-unused-with-gears = Das hat bei Zahnrädern keine Bedeutung; lassen Sie es weg.
simulation-train-input-fixed = Der Antrieb dieses Getriebes steht fest; es gibt daher keine Bewegung zu simulieren.
simulation-gears-as-discs = Die Räder sind Scheiben aus { $material } ({ $density } kg/m³) mit ihren Teilkreisdurchmessern.
simulation-unused-with-gear-train = Das hat bei einem Zahnradgetriebe keine Bedeutung; lassen Sie es weg.
simulation-shafts-side-by-side = Nicht parallele Wellen liegen nebeneinander, wie in der Zeichnung.
simulation-gears-do-not-fit = Die Räder dieses Getriebes passen nicht zusammen und haben daher keine Lagen.
simulation-speed-engaged = Drehzahl { $number } von { $count } ist eingelegt.
simulation-gear-engaged = Eingelegt: { $gear }. Die Räder, die auf der Hauptwelle frei laufen, zählen als Teile von ihr.
simulation-gear-out-of-range = Dieses Getriebe hat die Gänge 1 bis { $count }.
