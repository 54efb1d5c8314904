# Errors of the statement

spring_balancing-nothing-to-balance = es gibt nichts auszugleichen: Schwerkraft mit Massen der Glieder oder eine Last angeben
spring_balancing-not-a-link = kein Glied; die Glieder sind { $links }
spring_balancing-ends-on-one-link = eine Feder wirkt zwischen zwei Gliedern; beide Enden liegen an { $link }
spring_balancing-end-too-far = zu weit vom Getriebe entfernt
spring_balancing-friction-not-supported = die besten Federn können nur ohne Reibung berechnet werden; weglassen

# Errors of a requested spring

spring_balancing-end-place-choice = genau eines von point und within angeben
spring_balancing-ends-or-links = die Enden einer Feder oder die Glieder einer Drehfeder angeben
spring_balancing-fields-of-other-type = bei dieser Art von Feder nicht anwendbar: { $fields }
spring_balancing-value-and-limits-given = entweder { $field } oder die Grenzen dazu angeben
spring_balancing-minimum-above-maximum = { $minimum } darf nicht größer als { $maximum } sein
spring_balancing-free-angles-excluded = die Grenzen des ungespannten Winkels schließen alles aus; die voreingestellte Grenze sind zehn Umdrehungen
spring_balancing-preload-limit-too-small = max_preload darf nicht kleiner als preload sein
spring_balancing-lengths-excluded = min_length muss kleiner als max_length sein
spring_balancing-compression-spring-form = eine Druckfeder braucht eine ungespannte Länge und hat keine Vorspannung
spring_balancing-free-length-unbounded = unbegrenzt: Die ungespannte Länge könnte wachsen, während die Federrate sinkt; max_free_length angeben
spring_balancing-diameter-not-applicable = nur eine Druckfeder hat einen Durchmesser, mit dem das Knicken geprüft wird

# Summaries

spring_balancing-none-found = Kein Entwurf gefunden.
spring_balancing-mechanism-not-held = Das Getriebe lässt sich über diese Bewegung nicht halten.
spring_balancing-drive-zero-already = Der Antrieb ist ohne Federn null; es gibt nichts auszugleichen.
spring_balancing-no-springs-within-limits = Es gibt keinen Entwurf: Keine solchen Federn halten ihre Grenzen über diese Bewegung ein.
spring_balancing-exact = Die Federn gleichen das Getriebe exakt aus: Der Antrieb ist über die Bewegung null.
spring_balancing-exact-with-constant-energy = Die Federn gleichen das Getriebe exakt aus: Über die Bewegung ist der Antrieb null und die potenzielle Energie konstant.
spring_balancing-best-found = Die Federn senken den Antrieb auf das { $value }-Fache des Werts ohne Federn. Das ist der beste gefundene Wert, kein bewiesenes Minimum.
spring_balancing-proven-minimum = Die Federn senken den Antrieb auf das { $value }-Fache des Werts ohne Federn; unter { $bound } senken ihn keine solchen Federn.
spring_balancing-bounded-minimum = Die Federn senken den Antrieb auf das { $value }-Fache des Werts ohne Federn; unter { $bound } senken ihn keine solchen Federn. Für die Werte dazwischen ist es nicht entschieden.

# Warnings

spring_balancing-positions-not-held = motion: Der Antrieb ist in { $known } von { $count } Stellungen bekannt; die anderen werden nicht beurteilt
spring_balancing-spring-buckles = springs/{ $number }: { $slenderness }-mal so lang wie breit; ohne Führung knickt sie

# Progress

spring_balancing-measuring-linkage = das Getriebe wird vermessen
spring_balancing-finding-springs = Federn werden gesucht
