# Contradictions.

train_series-size-needs-tolerance = die Rangfolge nach Größe braucht eine Toleranz der Übersetzung
train_series-hunting-teeth-not-preferable =
    eine Einheit einer Reihe hat keine Getriebe mit gleichem Fehler, die zu bevorzugen wären; any oder require wählen
train_series-shafts-not-parallel =
    alle Wellen einer Reihe sind parallel; die einer Stufe der Art { $type } sind es nicht
train_series-unknown-type = type ist erforderlich und muss eines von diesen sein: { $types }

# Searches that are too large. $trains, $series, $limit: rounded numbers such as 5e+07.

train_series-ordinary-unit-too-large =
    etwa { $trains } Getriebe überschreiten die Grenze von { $limit } je Einheit; weniger Zähnezahlen zulassen oder ihre
    Stufen zu eigenen Einheiten machen
train_series-planetary-unit-too-large =
    etwa { $trains } Getriebe überschreiten die Grenze von { $limit } je Einheit; weniger Zähnezahlen zulassen oder eine
    Bauart und ihre Glieder angeben
train_series-too-many-series =
    etwa { $series } Reihen sind zu viele für die Suche; weniger Zähnezahlen zulassen oder Glieder angeben

# Progress of the search.

train_series-listing-teeth = Einheit { $unit }: Zähnezahlen
train_series-searching = { $series } Reihen
train_series-verifying = Prüfung läuft
train_series-verified = geprüft

# Summary. $product: the ratios of the units, such as 5 × 6.25; $searched: the series searched, and the number of
# equally exact ones if there are several.

train_series-best-exact = { $product } ist genau { $ratio }; { $searched }.
train_series-best-nearest = { $product } ist { $reached } statt { $ratio }, ein Fehler von { $error } %; { $searched }.
train_series-unit-without-trains =
    Es gibt keine solche Reihe: Kein Getriebe erfüllt die Bedingungen von Einheit { $unit }.
train_series-none-turns-same = Es gibt keine solche Reihe: In keiner drehen An- und Abtrieb gleichsinnig; { $searched }.
train_series-none-turns-opposite =
    Es gibt keine solche Reihe: In keiner drehen An- und Abtrieb gegensinnig; { $searched }.
train_series-none-verified = Keine Reihe hat die Prüfung bestanden; { $searched }.
train_series-nearest-too-far =
    Es gibt keine solche Reihe: Die nächste hat die Übersetzung { $ratio }, ein Fehler von { $error } %; { $searched }.
train_series-searched =
    { $count ->
        [one] { $count } Reihe untersucht
       *[other] { $count } Reihen untersucht
    }
train_series-ties = { $count } Reihen haben diesen Fehler
