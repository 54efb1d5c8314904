# Remarks on a design without manufacturing results, or with some only

manufacture-type-not-supported = für { $mechanism } nicht verfügbar
manufacture-not-assembled-at-reference = das Getriebe schließt in seiner Bezugsstellung nicht
manufacture-not-assembled-at-targets = das Getriebe schließt nicht in jedem Ziel
manufacture-toggle-at-target = das Getriebe steht in einem Ziel in einer Totlage
manufacture-toggle-within-clearances = im Rahmen des Spiels seiner Gelenke erreicht das Getriebe in einem Ziel eine Totlage
