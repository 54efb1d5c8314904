### Parallelführung: Ein Sechsgelenk führt einen Körper auf einer Koppelkurve, ohne ihn zu drehen.
### Fehler stehen hinter dem Namen eines Felds, ohne Punkt am Ende.

# Fortschritt einer Suche und ihr Verfahren.

parallel_motion-verified = geprüft
parallel_motion-method = Ersatzgetriebe, eines davon an den Gestellpunkt des anderen verschoben

# Fehler in der Aufgabe.

parallel_motion-no-cognates =
    nur ein Viergelenk hat die Ersatzgetriebe, die den Körper führen; für ein anderes Getriebe die Bahn seines Punkts
    angeben
parallel_motion-linkage-or-path = entweder linkage oder path angeben
parallel_motion-belongs-to-sixbar =
    gebaut wird das Sechsgelenk, nicht das Viergelenk; diese Angabe gehört neben path
parallel_motion-pivots-coincide = gleich dem Gestellpunkt des Antriebs; das Gestell hat keine Länge
parallel_motion-link-too-long = ein Glied ist mindestens so lang wie die anderen zusammen
parallel_motion-ground-disagrees = die Gestellpunkte ergeben { $length }; das Feld weglassen oder berichtigen
parallel_motion-links-too-short =
    zu kurz gegenüber den Koordinaten der Gestellpunkte; den Nullpunkt näher heranlegen
parallel_motion-point-on-pin =
    auf einem Gelenk der Koppel läuft P auf einem Kreis und hat kein Ersatzgetriebe; dort führt ein Parallelogramm den
    Körper
parallel_motion-input-angle-impossible =
    das Getriebe lässt sich bei diesem Antriebswinkel nicht zusammenbauen; den Winkel weglassen oder berichtigen
parallel_motion-skeleton-of-other-type =
    nicht das eines Viergelenks mit den Gliedern O2–O4, O2–A, A–B–P und O4–B; weglassen
parallel_motion-joint-disagrees = nach den Abmessungen liegt { $joint } bei ({ $x }; { $y }); skeleton weglassen

# Zusammenfassung.

# Steht anstelle der Gründe, aus denen Entwürfe ausgeschieden sind, wenn es keinen Kandidaten gibt.
parallel_motion-no-fourbar = kein Viergelenk
parallel_motion-none-carries =
    { $candidates ->
        [one] Das eine Sechsgelenk führt den Körper nicht auf der Kurve ({ $reasons }).
       *[other] Keines von { $candidates } Sechsgelenken führt den Körper auf der Kurve ({ $reasons }).
    }
parallel_motion-sixbars-carry =
    { $passed } von { $candidates ->
        [one] { $candidates } Sechsgelenk
       *[other] { $candidates } Sechsgelenken
    } { $passed ->
        [one] führt
       *[other] führen
    } den Körper auf der Kurve, ohne ihn zu drehen.
parallel_motion-best-design =
    Bester Entwurf: kleinster Übertragungswinkel { $angle }°, angetrieben bei Q = ({ $x }; { $y }) relativ zu P.
parallel_motion-best-design-swings =
    Bester Entwurf: kleinster Übertragungswinkel { $angle }° (auf einem Teil der Kurve hin und her bewegt), angetrieben
    bei Q = ({ $x }; { $y }) relativ zu P.

## Fortschritt

parallel_motion-progress-driving-sixbars = Sechsgelenke werden durchgefahren
