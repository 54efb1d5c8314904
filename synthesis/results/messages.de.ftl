# Names of checks, metrics and limits in words. German selects by the name; English writes it with spaces

results-name-in-words =
    { $name ->
        [assembly] Einbau
        [balancers] Ausgleichsmassen
        [bore] Bohrung
        [bound] Schranke
        [box] Hülle
        [branch_defect] Zweigwechsel
        [cannot_be_driven] nicht durchfahrbar
        [centre_distance] Achsabstand
        [chain] Gliederkette
        [circuit_defect] Wechsel des Bewegungsbereichs
        [clears_pivot] frei vom Drehpunkt
        [cluster_difference] Zähnedifferenz im Räderblock
        [coaxial] koaxial
        [coefficient] Ungleichförmigkeitsgrad
        [constraints] Bedingungen
        [contact_force] Kontaktkraft
        [contact_on_profile] Kontaktkraft am Profil
        [contact_ratio] Profilüberdeckung
        [convex] konvex
        [coupler_point] Koppelpunkt
        [covers_range] deckt den Bereich ab
        [crank_does_not_turn] Kurbel läuft nicht um
        [crank_phase] Phase der Kurbel
        [crank_shaft] Kurbelwelle
        [crank_turns] Kurbel läuft um
        [crescent] Sichelbreite
        [curvature_ratio] Krümmungsverhältnis
        [curve_within_tolerance] Kurve in der Toleranz
        [degenerate] entartet
        [demanded_springs] geforderte Federn
        [deviation] Abweichung
        [dials] Skalen
        [direction] Richtung
        [disc_clears_wheel] Scheibe frei vom Rad
        [disc_radius] Scheibenradius
        [does_not_cross_itself] schneidet sich nicht selbst
        [does_not_turn] läuft nicht um
        [drive] Antrieb
        [drive_torque] Antriebsmoment
        [driver_coupler] Koppel des Antriebszweischlags
        [driver_pivot_region] Bereich des Antriebsgestellpunkts
        [dwells_apart] Rasten getrennt
        [efficiency] Wirkungsgrad
        [energy_balance] Energiebilanz
        [equal_stops] gleiche Raststellen
        [equal_tooth_sums] gleiche Zähnesummen
        [even_firing] gleichmäßige Zündung
        [exact_line] exakte Gerade
        [face_width] Zahnbreite
        [falls_in] fällt ein
        [far_from_the_curve] fern von der Kurve
        [fillet_interference] Störung im Zahnfuß
        [fires_at_top] Zündung im oberen Totpunkt
        [firing_order] Zündfolge
        [fixed_pivot_region] Bereich der Gestellpunkte
        [fixed_pivot_zones] Bereiche der Gestellpunkte
        [fixed_pivots] Gestellpunkte
        [follower_can_be_laid_on] Eingriffsglied kann anliegen
        [forces_by_reactions] Kräfte aus Auflagerreaktionen
        [free_angle] Winkel ungespannt
        [frequency_ratio] Frequenzverhältnis
        [full_rotation] voller Umlauf
        [gap] Abstand
        [grade] Auswuchtgüte
        [grashof] Grashof
        [ground_line] Gestellgerade
        [gyration] Trägheitsradius
        [harmonics] Harmonische
        [holds_the_torque] hält das Moment
        [hub_radius] Nabenradius
        [hunting_tooth] teilerfremde Zähnezahlen
        [inertia_over_disc] Trägheit gegenüber der Scheibe
        [interference] Eingriffsstörung
        [joint_force] Gelenkkraft
        [joint_force_index] Gelenkkraftindex
        [keeps_the_statement] hält die Aufgabe ein
        [lift_as_told] Hub wie genannt
        [limits] Grenzen
        [link_length] Gliedlänge
        [link_ratio] Gliedverhältnis
        [locked_at_rest] in Ruhe verriegelt
        [locked_rest] verriegelte Rast
        [locking_angle] Sperrwinkel
        [locking_as_told] Verriegelung wie genannt
        [locking_cap] Sperrkappe
        [locking_disc] Sperrscheibe
        [longest_link] längstes Glied
        [max_angle_error] größter Winkelfehler
        [max_dwell_share] größter Rastanteil
        [max_error] größter Fehler
        [max_thickness] größte Dicke
        [meets_positions] erfüllt die Lagen
        [min_dwell_share] kleinster Rastanteil
        [min_radius] kleinster Radius
        [min_thickness] kleinste Dicke
        [module] Modul
        [moving_pivot_region] Bereich der Gelenkpunkte
        [moving_pivot_zones] Bereiche der Gelenkpunkte
        [no_cusp] keine Spitze
        [no_drag_link_found] keine Doppelkurbel gefunden
        [no_face_locks] keine Flanke sperrt
        [no_room_for_walls] kein Platz für Wände
        [no_such_linkage] kein solches Getriebe
        [not_at_rest] nicht in Rast
        [not_steered] nicht herangeführt
        [obstacles] Hindernisse
        [on_curve] auf der Kurve
        [on_grid] auf dem Raster
        [order_defect] falsche Reihenfolge
        [outer_wall_is_sound] äußere Wand einwandfrei
        [outranked] schlechter platziert
        [outside_room] außerhalb des Bauraums
        [overturning_moment] Kippmoment
        [overturning_on_profile] Kippmoment am Profil
        [passing_roller] vorbeilaufende Rolle
        [pawl_rides] Klinke gleitet
        [pawls_at_every_stop] Klinken an jeder Raststelle
        [peak_acceleration] Spitzenbeschleunigung
        [peaks] Spitzenwerte
        [pin_distance] Bolzenabstand
        [pin_force] Rollenkraft
        [pin_forces] Gelenkkräfte
        [piston_series] Reihe des Kolbens
        [planes] Ebenen
        [play] Spiel
        [positions_not_held] Lagen nicht gehalten
        [potential_energy] potenzielle Energie
        [power] Leistung
        [pressure_angle] Pressungswinkel
        [pressure_angle_fall] Pressungswinkel im Rückgang
        [primary_force] Kraft erster Ordnung
        [primary_moment] Moment erster Ordnung
        [program_is_driven] Bewegungsgesetz durchfahren
        [radius] Radius
        [radius_to_thickness] Radius zu Dicke
        [ratio] Übersetzung
        [ratio_error] Übersetzungsfehler
        [ratios] Übersetzungen
        [reach] Reichweite
        [reaches_ends] erreicht die Enden
        [reaches_locks] erreicht die Einschläge
        [reaches_next_station] erreicht die nächste Station
        [reaches_targets] erreicht die Ziele
        [relative_face_width] Zahnbreite in Moduln
        [residual] Restfehler
        [reverse_fits] Rückwärtsgang passt
        [reversed_link] umgekehrtes Glied
        [rim_speed] Umfangsgeschwindigkeit
        [ring_diameter] Durchmesser des Hohlrads
        [ring_trimmed] Hohlrad beschnitten
        [roller_clears_wheel] Rolle frei vom Rad
        [roller_distance] Rollenabstand
        [roller_in_slot] Rolle im Schlitz
        [rotation] Drehung
        [routes_agree] Rechenwege stimmen überein
        [same_branch] gleicher Zweig
        [same_circuit] gleicher Bewegungsbereich
        [second_does_not_cross_itself] zweite schneidet sich nicht selbst
        [second_no_cusp] zweite ohne Spitze
        [second_reproduces_program] zweite erfüllt das Bewegungsgesetz
        [secondary_force] Kraft zweiter Ordnung
        [secondary_moment] Moment zweiter Ordnung
        [shaking_force] Gestellkraft
        [shaking_force_accelerated] Gestellkraft bei Beschleunigung
        [shaking_moment] Gestellmoment
        [shaking_moment_accelerated] Gestellmoment bei Beschleunigung
        [shock_free_entry] stoßfreier Eintritt
        [shortest_link] kürzestes Glied
        [size] Größe
        [size_as_told] Größe wie genannt
        [speed_repeats] Drehzahl wiederholt sich
        [speeds] Drehzahlen
        [spring_without_direction] Feder ohne Richtung
        [stage_ratio] Stufenübersetzung
        [stage_types] Stufenarten
        [stance_flatness] Ebenheit der Standphase
        [stance_speed] Geschwindigkeit der Standphase
        [steady_as_told] Gleichlauf wie genannt
        [steady_share] Gleichlaufanteil
        [steering_error] Lenkfehler
        [steers_correctly] lenkt richtig
        [stock] Vorrat
        [strength] Tragfähigkeit
        [stroke] Hub
        [swing] Schwingwinkel
        [teeth] Zähne
        [tie_rod_clearance] Abstand der Spurstange vom Rad
        [time_ratio] Zeitverhältnis
        [tip_thickness] Zahnkopfdicke
        [tolerance] Toleranz
        [tooth_limits] Zähnezahlgrenzen
        [tooth_thickness] Zahndicke
        [torque] Moment
        [total_mass] Gesamtmasse
        [total_teeth] Gesamtzähnezahl
        [touches_everywhere] überall in Kontakt
        [translates] ohne Drehung
        [transmission_angle] Übertragungswinkel
        [transmission_as_told] Übertragung wie genannt
        [undercut] Unterschnitt
        [unsound] nicht einwandfrei
        [velocity_variation] Geschwindigkeitsschwankung
        [vibration] Schwingung
        [visits_in_order] erreicht der Reihe nach
        [wall] Wand
        [walls_as_told] Wände wie genannt
        [web] Stegdicke
        [within_tolerance] in der Toleranz
        [yield] Gutanteil
       *[other] { $words }
    }

# Parts of sentences

results-quantity = { $number } { $unit }
results-list-with-and = { $first } und { $last }

# Reasons of rejection with the number of candidates

results-reason-with-count = { $reason } { $count }
results-rejected = Ausgeschieden: { $reasons }.

# Why the forces of a design are unknown; the reasons follow the colon of forces-unknown

results-forces-unknown = Die Kräfte dieses Entwurfs sind nicht bekannt: { $reason }.
results-no-mechanism-from-dimensions = aus diesen Maßen lässt sich kein Getriebe aufbauen
results-no-verified-motion = der Entwurf hat keine geprüfte Bewegung
results-sliding-speed-missing = der Antrieb dieses Getriebes ist ein Schieber; seine Geschwindigkeit angeben
results-rotating-speed-missing = der Antrieb dieses Getriebes dreht sich; seine Drehzahl angeben

# Order of the designs by a measured quantity

results-ranked-by-planes =
    { $count ->
        [one] Gereiht nach der Anzahl der Ebenen ({ $count } Entwurf in Ebenen angeordnet): { $minimum } bis { $maximum } sind nötig.
       *[other] Gereiht nach der Anzahl der Ebenen ({ $count } Entwürfe in Ebenen angeordnet): { $minimum } bis { $maximum } sind nötig.
    }
results-ranked-by-planes-equal =
    { $count ->
        [one] Gereiht nach der Anzahl der Ebenen ({ $count } Entwurf in Ebenen angeordnet): Jeder baubare braucht { $planes }.
       *[other] Gereiht nach der Anzahl der Ebenen ({ $count } Entwürfe in Ebenen angeordnet): Jeder baubare braucht { $planes }.
    }
results-ranked-by-planes-none-buildable =
    { $count ->
        [one] Gereiht nach der Anzahl der Ebenen ({ $count } Entwurf in Ebenen angeordnet): Keiner ist baubar.
       *[other] Gereiht nach der Anzahl der Ebenen ({ $count } Entwürfe in Ebenen angeordnet): Keiner ist baubar.
    }
results-ranked-by-measure =
    { $count ->
        [one] Gereiht nach: { $name } ({ $count } Entwurf vermessen), von { $minimum } bis { $maximum }.
       *[other] Gereiht nach: { $name } ({ $count } Entwürfe vermessen), von { $minimum } bis { $maximum }.
    }
results-ranked-by-equal-measure =
    { $count ->
        [one] Gereiht nach: { $name } ({ $count } Entwurf vermessen), { $value }.
       *[other] Gereiht nach: { $name } ({ $count } Entwürfe vermessen), { $value }.
    }
results-ranked-by-unknown-measure =
    { $count ->
        [one] Gereiht nach: { $name } ({ $count } Entwurf vermessen); der Wert ist bei keinem bekannt.
       *[other] Gereiht nach: { $name } ({ $count } Entwürfe vermessen); der Wert ist bei keinem bekannt.
    }

# Order of the designs by practicality; a band is the permitted multiple of the smallest error

results-no-design-practical =
    { $among ->
        [buildable] Keiner dieser baubaren Entwürfe hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
        [listed] Keiner dieser Entwürfe hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
       *[found] Kein gefundener Entwurf hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
    }
results-no-near-design-practical =
    { $among ->
        [buildable] Keiner dieser baubaren Entwürfe mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
        [listed] Keiner dieser Entwürfe mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
       *[found] Kein gefundener Entwurf mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }, ohne dass ein Glied länger als das { $reach }-Fache der Größe der Aufgabe ist.
    }
results-no-design-with-even-links =
    { $among ->
        [buildable] Keiner dieser baubaren Entwürfe hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
        [listed] Keiner dieser Entwürfe hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
       *[found] Kein gefundener Entwurf hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
    }
results-no-near-design-with-even-links =
    { $among ->
        [buildable] Keiner dieser baubaren Entwürfe mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
        [listed] Keiner dieser Entwürfe mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
       *[found] Kein gefundener Entwurf mit höchstens dem { $band }-Fachen des kleinsten Fehlers hat einen Übertragungswinkel von mindestens { $angle }° und ein Gliedverhältnis von höchstens { $ratio }.
    }
results-sound-found-by-limits =
    { $count ->
        [one] Eine zweite Suche, die einen Übertragungswinkel von { $angle }° und ein Gliedverhältnis von { $ratio } forderte, fand { $count } Entwurf; sein Fehler ist { $error }.
       *[other] Eine zweite Suche, die einen Übertragungswinkel von { $angle }° und ein Gliedverhältnis von { $ratio } forderte, fand { $count } Entwürfe; ihr kleinster Fehler ist { $error }.
    }
results-sound-found-far = Eine zweite Suche, die einen Übertragungswinkel von { $angle }° und ein Gliedverhältnis von { $ratio } forderte, fand keinen Entwurf mit einem Fehler unter { $error }.
results-sound-before-accurate = Sie stehen vor genaueren Entwürfen, die schlecht übertragen oder sehr ungleiche Glieder haben.
results-first-for-soundness = Der Fehler des ersten Entwurfs ist { $error }, der von Entwurf { $number } { $nearest }; dafür hat der erste einen Übertragungswinkel von { $angle }° statt { $nearest_angle }° und ein Gliedverhältnis von { $ratio } statt { $nearest_ratio }.
results-first-less-accurate = Entwurf { $number } ist genauer: Sein Fehler ist { $nearest } statt { $error }.
results-unbuildable-last =
    { $count ->
        [one] Ein Entwurf steht zuletzt, weil er nicht baubar ist: Seine Glieder müssten schmaler als { $share } % der Länge des längsten sein oder würden in jeder Anordnung in Ebenen zusammenstoßen.
       *[other] { $count } Entwürfe stehen zuletzt, weil sie nicht baubar sind: Ihre Glieder müssten schmaler als { $share } % der Länge des längsten sein oder würden in jeder Anordnung in Ebenen zusammenstoßen.
    }
results-none-buildable = Keiner dieser Entwürfe ist wie üblich baubar: Die Glieder des ersten wären höchstens { $width } { $unit } breit, weniger als { $share } % seines längsten Gliedes.
results-none-buildable-in-planes = Keiner dieser Entwürfe ist baubar: In jeder Anordnung in Ebenen stoßen Glieder oder Bolzen zusammen.
results-unbuildable-in-layout =
    { $count ->
        [one] Ein Entwurf ist mit den Maßen der Anordnung nicht baubar und steht zuletzt.
       *[other] { $count } Entwürfe sind mit den Maßen der Anordnung nicht baubar und stehen zuletzt.
    }
results-none-buildable-in-layout = Keiner dieser Entwürfe ist mit den Maßen der Anordnung über die ganze Bewegung baubar.
results-extra-links = Entwurf { $number } hat { $links } Glieder mehr als Entwurf { $simple }: Sein kleinster Übertragungswinkel ist { $changed }° statt { $angle }°.
results-extra-links-and-error = Entwurf { $number } hat { $links } Glieder mehr als Entwurf { $simple }: Sein Fehler ist { $other } statt { $error }, sein kleinster Übertragungswinkel { $changed }° statt { $angle }°.
results-extra-links-and-negligible-error = Entwurf { $number } hat { $links } Glieder mehr als Entwurf { $simple }: Sein Fehler ist { $other } statt { $error }, ein Unterschied unterhalb üblicher Toleranzen, sein kleinster Übertragungswinkel { $changed }° statt { $angle }°.

# Rounding to a grid

results-rounded =
    { $kept ->
        [one] Auf das Raster gerundet: { $kept } von { $count } Entwürfen erfüllt weiterhin alle Bedingungen.
       *[other] Auf das Raster gerundet: { $kept } von { $count } Entwürfen erfüllen weiterhin alle Bedingungen.
    }

# Ends of sentences that compare other types of linkage with the best simpler one; they follow the last word

results-alternatives-not-listed = ; wegen max_designs sind sie nicht aufgeführt.
results-alternatives-listed-too = ; sie sind zusätzlich aufgeführt.
results-alternatives-listed-instead = ; sie sind stattdessen aufgeführt.

# Progress

results-verifying = Prüfung läuft
results-verified = geprüft
