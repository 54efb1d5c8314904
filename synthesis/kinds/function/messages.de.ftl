### Übertragungsfunktionen: Getriebe, deren Abtrieb dem Antrieb folgt.

## Fehler einer Aufgabe. Jeder folgt auf den Namen eines Feldes.

# Der Grund eines Fehlers, den das Modell um einen Rat ergänzt.
function-class-needs-fourbar = gilt nur für Viergelenke; eine Schubkurbel hat keine Klasse
function-pivots-coincide = stimmt mit dem Gestellpunkt des Antriebs überein; das Gestellglied hätte die Länge null
function-range-limits-outside = muss zwischen { $lowest } und { $highest } Grad liegen
function-range-outside = ein Bereich muss zwischen { $lowest } und { $highest } Grad liegen
function-scales-not-positive = Skalen müssen positiv sein
function-pairs-or-function = entweder Wertepaare oder eine Funktion angeben
function-field-is-for-functions = gilt nur für eine Funktion; bei Wertepaaren ergibt es sich aus den Paaren
function-scales-are-for-pairs = gilt nur für Wertepaare; eine Funktion hat Bereiche
# $criterion ist ein Wert des Feldes criterion.
function-criterion-uses-no-points = { $criterion } nähert den ganzen Bereich an und verwendet keine Genauigkeitspunkte
function-inputs-equal = stimmt mit dem von Paar { $pair } überein; die Antriebswinkel müssen verschieden sein
function-inputs-cover-turn = die Antriebswinkel überstreichen eine volle Umdrehung oder mehr
function-inputs-unordered = die Antriebswinkel müssen von Paar zu Paar steigen oder fallen, es sei denn, in_order ist false
function-outputs-cover-turn = die Abtriebswinkel überstreichen eine volle Umdrehung oder mehr
function-output-rests = der Abtrieb bewegt sich nicht
function-too-many-pairs = höchstens { $count } Wertepaare können exakt erfüllt werden; Nullstellungen oder Skalen offen lassen oder ein anderes Kriterium wählen
function-too-many-sixbar-pairs = höchstens { $count } Wertepaare können exakt erfüllt werden; für neun nur watt_2 verlangen oder ein anderes Kriterium wählen
function-too-many-points = höchstens { $count } Punkte können exakt erfüllt werden; Nullstellungen oder Bereiche offen lassen
function-too-many-sixbar-points = höchstens { $count } Punkte können exakt erfüllt werden; für neun nur watt_2 verlangen
function-slider-range-missing = der Bereich eines Schiebers bestimmt die Größe des Getriebes und muss angegeben werden
function-slider-scale-missing = muss angegeben werden: die Skala eines Schiebers ändert nur die Größe des Getriebes
function-nine-pairs-need-it = muss angegeben werden, weil neun Wertepaare nur dann endlich viele Sechsgelenke zulassen
function-sixbar-output-rotates = der Abtrieb von Getrieben mit sechs und mehr Gliedern dreht; sie aus mechanisms entfernen
function-zeros-need-fourbar = werden von der Gestellgeraden eines Viergelenks aus gemessen; für Getriebe mit mehr Gliedern offen lassen
function-slider-crank-not-alone = slider_crank hat als Abtrieb eine Länge, alle anderen Arten haben einen Winkel: allein aufführen und auch mechanism darauf setzen

## Fehler einer mathematischen Funktion; $function ist ihr Name in der Anfrage.

function-table-not-rising = x muss von Zeile zu Zeile der Tabelle steigen
function-table-too-short = die Tabelle deckt dieses Intervall nicht ab
function-interval-missing = das Intervall von x angeben
function-interval-too-short = das Intervall ist im Verhältnis zu seinen Werten zu kurz
function-values-infinite = { $function } ist in diesem Intervall nicht überall endlich
function-values-constant = { $function } ist in diesem Intervall im Rahmen der Rechengenauigkeit konstant
function-field-unused = gilt nur für { $function }
function-field-required = ist für { $function } erforderlich
function-base-unused = gilt nur für exponential und logarithm
function-base-one = mit der Basis 1 ist die Funktion konstant
function-exponent-zero = mit dem Exponenten 0 ist die Funktion konstant
function-logarithm-of-zero = der Logarithmus verlangt ein Intervall über 0
function-reciprocal-of-zero = 1/x ist bei 0 nicht definiert, und 0 liegt im Intervall
function-tangent-undefined = der Tangens ist bei { $angle }° nicht definiert, und dieser Winkel liegt im Intervall
function-negative-power-of-zero = eine negative Potenz ist bei 0 nicht definiert, und 0 liegt im Intervall
function-power-of-negative = ein nicht ganzzahliger Exponent verlangt ein Intervall ohne negative Werte

## Fortschritt. $type ist der Name einer Art in der Anfrage, etwa watt_2.

function-reading-problem = Aufgabe wird gelesen
function-solving-scales = Skalen werden bestimmt
function-family-members = { $count } Getriebe der Schar
function-fitting-family = Getriebe der Schar werden in die Grenzen bewegt
function-starts = { $count ->
        [one] { $count } Startwert
       *[other] { $count } Startwerte
    }
function-improving-start = Startwert { $number } von { $count }
function-improving-candidate = Kandidat { $number }
function-linkages-of-type = { $type ->
        [eightbar] { $count ->
            [one] { $count } achtgliedriges Getriebe
           *[other] { $count } achtgliedrige Getriebe
        }
       *[other] { $count ->
            [one] { $count } Sechsgelenk der Art { $type }
           *[other] { $count } Sechsgelenke der Art { $type }
        }
    }
function-following-linkages = { $linkages }: die besten werden verfolgt
function-improving-linkages = { $linkages }: die besten werden verbessert
function-paths-followed = { $done } von { $count } Wegen verfolgt
function-paths-to-nine-followed = { $done } von { $count } Wegen zu neun der Wertepaare verfolgt
function-verifying-best-linkages = die besten von { $count } Getrieben werden geprüft
function-verifying = Prüfung läuft
function-verified = geprüft

## Zusammenfassungen

function-values-read-as-angles = Die Werte wurden als Winkel zur Gestellgeraden gelesen; die Nullstellungen können stattdessen offen bleiben.
# Es folgt die Zusammenfassung der Suche mit offenen Nullstellungen.
function-zeros-left-open = Kein Getriebe mit den Werten als Winkeln zur Gestellgeraden erfüllt alle Bedingungen. Mit offenen Nullstellungen:
# $unit ist ein Gradzeichen oder, mit einem Leerzeichen davor, eine Längeneinheit.
function-least-maximum =
    Der beste gefundene Entwurf hat einen größten Strukturfehler von { $maximum }{ $unit } ({ $extremes ->
        [one] { $extremes } Extremwert
       *[other] { $extremes } Extremwerte mit wechselndem Vorzeichen
    }). { $improved } von { $count ->
        [one] { $count } Startwert
       *[other] { $count } Startwerten
    } { $improved ->
        [one] wurde
       *[other] wurden
    } optimiert; es kann ein besseres Getriebe geben.
function-least-rms =
    Der beste gefundene Entwurf hat einen mittleren Strukturfehler (RMS) von { $rms }{ $unit } (Maximum { $maximum }{ $unit }). { $improved } von { $count ->
        [one] { $count } Startwert
       *[other] { $count } Startwerten
    } { $improved ->
        [one] wurde
       *[other] wurden
    } optimiert; es kann ein besseres Getriebe geben.
function-no-start-passes =
    Kein Entwurf gefunden: { $improved } von { $count ->
        [one] { $count } Startwert
       *[other] { $count } Startwerten
    } { $improved ->
        [one] wurde
       *[other] wurden
    } optimiert, aber kein Ergebnis erfüllt alle Bedingungen.
function-real-linkages-pass =
    { $passed } von { $count ->
        [one] { $count } reellen Getriebe
       *[other] { $count } reellen Getrieben
    } { $passed ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
# Diese Sätze folgen auf die Anzahl der Getriebe, die die Bedingungen erfüllen; sie ist 0.
function-no-design-exists = Das sind alle, also gibt es keinen Entwurf.
function-no-such-type-exists = Das sind alle, also gibt es keinen Entwurf dieser Art.
function-others-may-exist = Es kann weitere geben.
function-designs-among-candidates =
    { $found ->
        [one] { $found } Entwurf
       *[other] { $found } Entwürfe
    } unter { $count } Kandidaten gefunden.
# $computed von $count Lösungen wurden gefunden; $accepted der $real reellen erfüllen die Bedingungen.
function-watts-computed =
    { $computed } von { $count } reellen und komplexen Lösungen für Sechsgelenke nach Watt II durch die neun Wertepaare wurden berechnet; { $real ->
        [one] { $real } ist
       *[other] { $real } sind
    } reell, und { $accepted } davon { $accepted ->
        [one] erfüllt
       *[other] erfüllen
    } alle Bedingungen.
# $pairs ist »nine«, wenn es neun Wertepaare gibt, und »more«, wenn neun davon ausgewählt wurden. $met kann 0 sein.
function-watts-meet-pairs =
    Alle { $count } reellen und komplexen Lösungen für Sechsgelenke nach Watt II durch { $pairs ->
        [nine] die neun Wertepaare
       *[more] neun der Wertepaare
    } wurden berechnet; { $met ->
        [0] keine davon erfüllt
        [one] { $met } davon erfüllt
       *[other] { $met } davon erfüllen
    } alle Wertepaare auf ein Millionstel Grad in einer Einbaulage.
function-many-watts-meet-pairs =
    Alle { $count } reellen und komplexen Lösungen für Sechsgelenke nach Watt II durch { $pairs ->
        [nine] die neun Wertepaare
       *[more] neun der Wertepaare
    } wurden berechnet; mindestens { $met } davon erfüllen alle Wertepaare auf ein Millionstel Grad in einer Einbaulage.
function-linkages-sampled = { $family ->
        [eightbar] { $sampled ->
            [one] { $sampled } achtgliedriges Getriebe wurde zufällig gezogen
           *[other] { $sampled } achtgliedrige Getriebe wurden zufällig gezogen
        }
       *[sixbar] { $sampled ->
            [one] { $sampled } Sechsgelenk wurde zufällig gezogen
           *[other] { $sampled } Sechsgelenke wurden zufällig gezogen
        }
    }
function-no-linkage-passes = { $effort }; kein gefundener Entwurf erfüllt alle Bedingungen.
function-nothing-proved = Das beweist nicht, dass es keinen gibt.
function-linkages-meet-pairs =
    { $effort }; { $count ->
        [one] { $count } Entwurf erfüllt
       *[other] { $count } verschiedene Entwürfe erfüllen
    } alle Wertepaare.
function-linkage-type = { $type ->
        [watt_2] ein Sechsgelenk nach Watt II
        [stephenson_2] ein Sechsgelenk nach Stephenson II
        [eightbar] ein achtgliedriges Getriebe
       *[stephenson_3] ein Sechsgelenk nach Stephenson III
    }
function-linkage-with-least-rms =
    { $effort }. Der beste gefundene Entwurf hat einen mittleren Strukturfehler (RMS) von { $rms }° (Maximum { $maximum }°);
    es ist { $type }. Es kann ein besseres Getriebe geben.
function-linkage-with-least-maximum =
    { $effort }. Der beste gefundene Entwurf hat einen größten Strukturfehler von { $maximum }°; es ist { $type }. Es kann
    ein besseres Getriebe geben.

## Vergleich von Viergelenken mit Sechsgelenken und von diesen mit achtgliedrigen Getrieben

function-only-sixbars-found = Es wurde kein Viergelenk gefunden, nur Sechsgelenke.
function-no-linkage-found = Es wurde weder ein Viergelenk noch ein Sechsgelenk gefunden.
function-no-smaller-error = Kein gefundenes Sechsgelenk hat einen deutlich kleineren Fehler als das beste Viergelenk.
function-no-better-transmission = Kein gefundenes Sechsgelenk hat einen deutlich größeren Übertragungswinkel als das beste Viergelenk.
function-only-eightbars-found = Es wurde kein Getriebe mit weniger Gliedern gefunden, nur achtgliedrige.
function-no-eightbar-found = Es wurde weder ein achtgliedriges Getriebe noch eines mit weniger Gliedern gefunden.
function-no-eightbar-with-smaller-error =
    Kein gefundenes achtgliedriges Getriebe hat einen deutlich kleineren Fehler als das beste mit weniger Gliedern.
function-no-eightbar-transmits-better =
    Kein gefundenes achtgliedriges Getriebe hat einen deutlich größeren Übertragungswinkel als das beste mit weniger
    Gliedern.
# Auf diese vier folgt ein Punkt oder der Rest des Satzes: ob die Getriebe mit mehr Gliedern aufgeführt sind.
function-sixbars-transmit-better = Der kleinste Übertragungswinkel des besten Viergelenks beträgt nur { $angle }°; Sechsgelenke übertreffen es
function-sixbars-reduce-error = Sechsgelenke senken den Fehler auf { $share } % des Fehlers des besten Viergelenks
function-eightbars-transmit-better =
    Der kleinste Übertragungswinkel des besten Getriebes mit weniger Gliedern beträgt nur { $angle }°; achtgliedrige
    übertreffen es
function-eightbars-reduce-error =
    Achtgliedrige Getriebe senken den Fehler auf { $share } % des Fehlers des besten Getriebes mit weniger Gliedern

## Fortschritt

function-progress-sixbars = Sechsgelenk { $next } von { $all } wird geprüft
