# Contradictions between mechanism and output.
quick_return-no-output = entweder den Schwingwinkel oder den Hub des Abtriebs angeben; keiner von beiden ist angegeben
quick_return-two-outputs = entweder den Schwingwinkel oder den Hub des Abtriebs angeben; beide sind angegeben
quick_return-swing-missing = der Abtrieb von { $mechanism } schwingt; seinen Schwingwinkel angeben
quick_return-stroke-of-rocker = der Abtrieb von { $mechanism } schwingt; den Hub weglassen
quick_return-stroke-missing = der Abtrieb von { $mechanism } gleitet; seinen Hub angeben
quick_return-swing-of-slider = der Abtrieb von { $mechanism } gleitet; den Schwingwinkel weglassen
quick_return-slider-with-rotopole = ein gleitender Abtrieb hat keinen Gestellpunkt; weglassen
quick_return-rotopole-for-crank-rocker-only =
    nur eine Kurbelschwinge lässt sich an einen Drehpol legen; als mechanism fourbar wählen
quick_return-crank-pivot-with-rotopole = der Drehpol bestimmt die Lage des Getriebes; dies weglassen

# Reasons why a required class of fourbars is impossible.
quick_return-mechanism-without-class =
    seine Kurbel läuft um, und das verlangte Getriebe gehört zu keiner Klasse von Viergelenken
quick_return-mechanism-is-crank-rocker = seine Kurbel läuft um, und das verlangte Getriebe ist eine Kurbelschwinge
quick_return-mechanism-is-double-crank = seine Kurbel läuft um, und das verlangte Getriebe ist eine Doppelkurbel
quick_return-mechanism-is-either =
    seine Kurbel läuft um, und das verlangte Getriebe ist eine Kurbelschwinge oder Doppelkurbel

# Contradictions with the positions of a body.
quick_return-field-with-positions = die Lagen des Körpers bestimmen dies; { $field } weglassen
quick_return-body-needs-fourbar = ein Körper wird von der Schwinge eines Viergelenks getragen
quick_return-body-does-not-turn =
    der Körper muss sich zwischen seinen Lagen drehen; eine Verschiebung hat keinen Drehpol
quick_return-rotopole-differs = der Drehpol der Lagen ist ({ $x }; { $y }); weglassen oder berichtigen

# Progress.
quick_return-designing = Entwurf: { $type }
quick_return-verified = geprüft

# Names of types. In German they begin with a noun, because sentences begin with them.
quick_return-fourbar = Viergelenk
quick_return-drag-link-rocker = Doppelkurbel mit Schwinge
quick_return-offset-slider-crank = Schubkurbel mit Versatz
quick_return-slider-crank = Schubkurbel
quick_return-crank-shaper = Kurbelschleife
quick_return-whitworth = Whitworth-Getriebe
quick_return-drag-link-slider = Doppelkurbel mit Schieber

# Reasons for the ends of the range of time ratios.
quick_return-crank-rocker-swing = eine Kurbelschwinge schwingt um weniger als 180°
quick_return-crank-rocker-two-circuits =
    ab { $ratio } liegen die Grenzlagen eines Schwingwinkels von { $swing }° in zwei Bewegungsbereichen
quick_return-drag-link-unlimited = eine Doppelkurbel läuft nahe ihrem Wechselpunkt beliebig ungleichmäßig
quick_return-drag-link-rocker-swing = ihre Schwinge ist die einer Kurbelschwinge, die um weniger als 180° schwingt
quick_return-coupler-square-to-slide = ab 3 müsste die Koppel durch eine Stellung rechtwinklig zur Schubgeraden gehen
quick_return-equal-strokes-without-crank = ein Zeitverhältnis von 1 verlangt eine Kurbel ohne Länge
quick_return-equal-strokes-at-one-pivot = ein Zeitverhältnis von 1 verlangt beide Gestellpunkte am selben Ort

# Ranges of time ratios.
quick_return-from = ab { $least }
quick_return-above = über { $least }
quick_return-from-to-below = von { $least } bis unter { $greatest }
quick_return-above-to-below = von über { $least } bis unter { $greatest }

# Summaries.
quick_return-designs-found =
    { $count ->
        [one] { $count } Entwurf hat
       *[other] { $count } Entwürfe haben
    } ein gemessenes Zeitverhältnis von { $ratio }. Der beste kleinste Übertragungswinkel beträgt { $angle }° ({ $type }).
quick_return-no-design-exists = Es gibt keinen Entwurf.
quick_return-no-design-found = Es wurde kein Entwurf gefunden.
quick_return-transmission-bound =
    Eine Schwinge mit einem Schwingwinkel von { $swing }° hat einen Übertragungswinkel unter { $bound }°, 90° minus dem
    halben Schwingwinkel.
quick_return-type-without-range =
    { $type }: Ein Zeitverhältnis von { $ratio } ist nicht erreichbar; mit diesem Abtrieb gibt es keines ({ $reason }).
quick_return-ratio-out-of-range =
    { $type }: Ein Zeitverhältnis von { $ratio } ist nicht erreichbar; der Bereich mit diesem Abtrieb ist { $range }
    ({ $reason }).
quick_return-type-does-not-exist = { $type }: Ein solches Getriebe gibt es nicht.
quick_return-type-not-found = { $type }: Ein solches Getriebe wurde nicht gefunden.
quick_return-link-ratio-impossible =
    { $type }: Mit einem Gliedverhältnis von höchstens { $link_ratio } gibt es ein solches Getriebe nicht.
quick_return-link-ratio-not-found =
    { $type }: Mit einem Gliedverhältnis von höchstens { $link_ratio } wurde ein solches Getriebe nicht gefunden.
