# Titles of errors

service-title-malformed-request = Fehlerhafte Anfrage
service-title-request-timeout = Anfrage zu langsam
service-title-head-too-large = Zu großer Kopf
service-title-no-drawing = Keine Zeichnung
service-title-no-motion = Keine Bewegung
service-title-no-forces = Keine Kräfte
service-title-no-simulation = Keine Simulation
service-title-unauthorized = Nicht berechtigt
service-title-rate-limited = Zu viele Anfragen
service-title-foreign-host = Fremder Rechnername
service-title-unsupported-media-type = Nicht unterstützter Medientyp
service-title-incomplete-body = Unvollständiger Inhalt
service-title-body-too-large = Zu großer Inhalt
service-title-invalid-request = Ungültige Anfrage
service-title-idempotency-key-reused = Idempotenzschlüssel wiederverwendet
service-title-malformed-json = Fehlerhaftes JSON
service-title-malformed-drawing = Fehlerhafte Zeichnung
service-title-invalid-drawing = Ungültige Zeichnung
service-title-store-unavailable = Auftragsspeicher nicht erreichbar
service-title-queue-full = Warteschlange voll
service-title-busy = Ausgelastet
service-title-gone = Verbindung getrennt
service-title-not-found = Nicht gefunden
service-title-method-not-allowed = Methode nicht erlaubt
service-title-http-error = HTTP-Fehler
service-title-internal-error = Interner Fehler
service-title-no-result = Kein Ergebnis
service-title-too-many-listeners = Zu viele Verbindungen
service-title-not-ready = Nicht bereit
service-title-part-of-batch = Teil eines Stapels
service-title-no-cad = Kein CAD
service-title-no-parts = Keine Teile
service-title-worker-died = Rechenprozess abgebrochen
service-title-timeout = Zeit überschritten
service-title-out-of-memory = Speicher erschöpft
service-title-invalid-problem = Ungültige Aufgabe
service-title-invalid-mechanism = Ungültiges Getriebe

# Requests as a whole

service-many-fields-invalid =
    Mehr als { $count } Felder der Anfrage sind ungültig; die ersten { $count } sind aufgeführt.
service-other-fields-invalid =
    { $count ->
        [one] { $count } weiteres Feld ist ungültig.
       *[other] { $count } weitere Felder sind ungültig.
    }
service-store-unavailable =
    Der Auftragsspeicher antwortet nicht. Die Anfrage später noch einmal senden; mit einem `Idempotency-Key` entsteht
    dabei höchstens ein Auftrag.
service-queue-full =
    Ihre Warteschlange hat die größte Zahl von Aufträgen erreicht. Die Anfrage später noch einmal senden.
service-client-gone = Der Client hat die Verbindung getrennt.
service-kernels-compiling =
    Die Rechenkerne für Analysen werden kompiliert, einmalig nach der Installation. `/readyz` meldet den Fortschritt.
service-path-unknown = Diese Ressource gibt es nicht; den Pfad prüfen.
service-request-not-served = Die Anfrage kann nicht bedient werden.
service-request-failed = Die Anfrage ist an einem Fehler des Dienstes gescheitert; sein Protokoll hat die Einzelheiten.
service-method-not-allowed = Dieser Pfad erlaubt { $method } nicht; er erlaubt { $methods }.
service-unknown-method-not-allowed = Dieser Pfad erlaubt diese Methode nicht; er erlaubt { $methods }.
service-key-invalid = Der API-Schlüssel ist nicht gültig.
service-key-missing = Einen API-Schlüssel senden: `Authorization: Bearer mechsynth_...`.
service-rate-limit-reached =
    Dieser Schlüssel hat seine Grenze von { $requests } Anfragen in { $seconds } Sekunden erreicht.
service-host-foreign =
    Ohne API-Schlüssel nimmt der Dienst nur Anfragen von diesem Rechner an, die an einen lokalen Rechnernamen gerichtet
    sind. `mechsynth keys create NAME` erzeugt einen Schlüssel.
service-body-compressed = Der Inhalt darf nicht komprimiert sein.
service-body-incomplete = Die Verbindung wurde vor dem Ende des Inhalts geschlossen.
service-body-not-json = Der Inhalt muss application/json sein.
service-body-too-large = Der Inhalt darf höchstens { $count } Bytes haben.
service-body-malformed = Der Inhalt ist kein gültiges JSON: { $reason }.
service-key-twice = Dieser Schlüssel kommt zweimal vor; ihn nur einmal angeben.
service-too-many-values-here = Bis hierher hat der Inhalt mehr als { $count } Werte; mehr sind nicht erlaubt.
service-too-many-values = Der Inhalt hat mehr als { $count } Werte.
service-nested-too-deeply = Dies ist mehr als { $count } Ebenen tief verschachtelt.
service-idempotency-key-twice = Nur einen `Idempotency-Key` senden.
service-idempotency-key-used =
    Eine andere Anfrage hat diesen `Idempotency-Key` verwendet. Für eine neue Anfrage einen neuen Schlüssel verwenden.
service-cursor-unknown = Erwartet wird ein `next_cursor` dieses Dienstes.
service-job-unknown = Kein Auftrag hat diese Kennung.
service-too-many-listeners = Zu viele Ihrer Clients verfolgen Aufträge; später noch einmal versuchen.

# Fields of requests

service-fault-at-place = { $path }: { $reason }
service-input-invalid = Dieser Wert ist hier nicht zulässig.
service-wrapper-missing = Die Anfrage braucht das Feld `{ $field }` um dieses Objekt: { $example }.
service-field-required-as = Dieses Feld ist erforderlich, etwa { $example }.
service-list-expected-as = Erwartet wird eine Liste, etwa { $example }.
service-object-expected-as = Erwartet wird ein Objekt, etwa { $example }.
service-input-resembles = Ist { $near } gemeint? Erwartet wird { $names } oder { $last }.
service-input-or-list = Erwartet wird { $names } oder eine Liste, etwa { $example }.
service-input-or-list-resembles = Ist { $near } gemeint? Erwartet wird { $names } oder eine Liste, etwa { $example }.
service-discriminator-resembles = Das Feld { $field } muss eines von diesen nennen: { $names }. Ist { $near } gemeint?
service-unknown-field-resembles-one-of =
    Unbekanntes Feld; ist `{ $field }` gemeint? Die Felder sind { $fields } und { $last }.
service-kind-missing = Dieses Feld ist erforderlich; möglich sind: { $names }.
service-kind-resembles = Unbekannt; ist { $near } gemeint? Möglich sind: { $names }.
service-kind-unsupported =
    Das leistet der Dienst nicht; siehe { $page }. Möglich sind: { $names }.
service-unknown-field = Unbekanntes Feld; den Namen prüfen.
service-field-required = Dieses Feld ist erforderlich.
service-list-expected = Erwartet wird eine Liste.
service-object-expected = Erwartet wird ein Objekt.
service-string-expected = Erwartet wird ein Text.
service-integer-expected = Erwartet wird eine ganze Zahl.
service-number-expected = Erwartet wird eine Zahl.
service-input-not-finite = Erwartet wird eine endliche Zahl.
service-boolean-expected = Erwartet wird true oder false.
service-input-greater-than = Der Wert muss größer als { $limit } sein.
service-input-greater-equal = Der Wert muss mindestens { $limit } sein.
service-input-less-than = Der Wert muss kleiner als { $limit } sein.
service-input-less-equal = Der Wert darf höchstens { $limit } sein.
service-kind-unknown = Unbekannt; möglich sind: { $names }.
service-output-unknown = Das Feld type muss eines von diesen nennen: { $names }.
service-unknown-field-resembles = Unbekanntes Feld; ist `{ $field }` gemeint?
service-unknown-field-besides-one = Unbekanntes Feld; das einzige Feld ist { $field }.
service-unknown-field-besides = Unbekanntes Feld; die Felder sind { $fields } und { $last }.
service-string-too-short = Der Text muss mindestens { $count } Zeichen haben.
service-string-too-long = Der Text darf höchstens { $count } Zeichen haben.
service-string-mismatch = Der Text muss dem Muster '{ $pattern }' entsprechen.
service-discriminator-missing = Das Feld { $field } ist erforderlich.
service-discriminator-unknown = Das Feld { $field } muss eines von diesen nennen: { $names }.
service-object-too-long =
    { $most ->
        [one] Das Objekt darf höchstens { $most } Eintrag haben.
       *[other] Das Objekt darf höchstens { $most } Einträge haben.
    }
service-list-too-long =
    { $most ->
        [one] Die Liste darf höchstens { $most } Eintrag haben, nicht { $count }.
       *[other] Die Liste darf höchstens { $most } Einträge haben, nicht { $count }.
    }
service-object-too-short =
    { $least ->
        [one] Das Objekt muss mindestens { $least } Eintrag haben, nicht { $count }.
       *[other] Das Objekt muss mindestens { $least } Einträge haben, nicht { $count }.
    }
service-list-too-short =
    { $least ->
        [one] Die Liste muss mindestens { $least } Eintrag haben, nicht { $count }.
       *[other] Die Liste muss mindestens { $least } Einträge haben, nicht { $count }.
    }
service-input-is = Erwartet wird { $name }.
service-input-one-of = Erwartet wird { $names } oder { $last }.
service-label-unprintable = die Bezeichnung darf weder NUL noch einzelne Surrogate enthalten

# Analyses, drawings and files

service-file-unavailable = Für diese Getriebeart gibt es keine .{ $form }-Datei.
service-design-too-large-to-draw = Die Größe dieses Entwurfs liegt außerhalb des Bereichs für Zeichnungen.
service-design-too-large-to-analyse = Die Größe dieses Entwurfs liegt außerhalb des Bereichs für Analysen.
service-forces-for-linkages-only = Gelenkkräfte gibt es nur für Koppelgetriebe.
service-problem-without-dynamics = Die Aufgabe hat kein `dynamics`; einen eigenen Block senden.
service-design-unknown = Den Entwurf { $number } gibt es nicht; dieser Auftrag hat die Entwürfe 0 bis { $last }.
service-job-without-designs = Dieser Auftrag hat keine Entwürfe.
service-computation-impossible =
    Die Berechnung ist mit diesen Zahlen gescheitert; alle Maße, Winkel und Anzahlen prüfen.
service-simulation-unavailable =
    Für diese Getriebeart gibt es keine Simulationen; es gibt sie für Koppelgetriebe und Rädergetriebe.
service-pmks-opens-linkages-only = PMKS+ öffnet nur Koppelgetriebe.
service-analysis-exceeds-time =
    Die Analyse hat ihre Zeitgrenze von { $seconds } s überschritten; alle Maße und Anzahlen prüfen.
service-analysis-exceeds-memory = Die Analyse hat ihre Speichergrenze überschritten; alle Maße und Anzahlen prüfen.
service-busy-with-analyses = Der Dienst ist mit anderen Analysen ausgelastet. Die Anfrage noch einmal senden.
service-drawing-exceeds-time = Die Zeichnung hat ihre Zeitgrenze von { $seconds } s überschritten.
service-drawing-exceeds-memory = Die Zeichnung hat ihre Speichergrenze überschritten.
service-busy-with-drawings = Der Dienst ist mit anderen Zeichnungen ausgelastet. Die Anfrage noch einmal senden.
service-file-type-foreign = Der Inhalt muss einen dieser Typen haben: { $types }.
service-busy-with-files = Der Dienst ist mit anderen Dateien ausgelastet. Die Anfrage noch einmal senden.
service-pixels-without-picture = Nur ein PNG-Bild hat Pixel; `pixel_size` weglassen.
service-solids-unavailable =
    Volumenkörper brauchen das Extra `cad`, das der Dienst nicht hat; `process=laser` liefert Umrisse ohne es.
service-busy-with-parts = Der Dienst ist mit anderen Teilen ausgelastet. Die Anfrage noch einmal senden.
service-parts-exceed-limits =
    Die Herstellung der Teile hat die Grenze von { $seconds } Sekunden oder die Speichergrenze eines Auftrags
    überschritten.

# Jobs

service-filter-kind-unknown = unbekannte Art; die Arten sind { $kinds }
service-problem-kind-unknown = Diese Art von Aufgabe gibt es nicht; die Arten sind { $kinds }.
service-documents-not-ready = Die Dokumente der Schnittstelle werden noch geschrieben; bitte bald wieder versuchen.
service-job-part-of-batch = Der Auftrag gehört zu einem Stapel; /v1/batches/{ $batch } entfernen.
service-job-ended-without-result = Der Auftrag hat den Status { $status } und kein Ergebnis.
service-job-without-result-yet = Der Auftrag hat noch kein Ergebnis.
service-store-file-lost = Die Datei der Datenbank wurde entfernt oder ersetzt; den Dienst anhalten und die Datei wiederherstellen.
service-store-full = Der Datenträger der Datenbank ist voll.
service-store-read-only = Die Datenbank lässt sich nur lesen.
service-store-silent = Der Auftragsspeicher antwortet nicht.
service-kernels-missing = Noch kein Rechenprozess ist fertig gestartet: Rechenkerne werden kompiliert, nach einer Installation etwa eine Minute lang.
service-no-worker-started = Noch kein Rechenprozess ist fertig gestartet.
service-computation-failed =
    Die Berechnung ist an einem Fehler des Dienstes gescheitert; sein Protokoll hat die Einzelheiten.
service-worker-died = Der Auftrag wurde aufgegeben, weil sein Rechenprozess in jedem Versuch abgebrochen ist.
service-time-limit-exceeded = Die Berechnung wurde an der Zeitgrenze von { $seconds } s beendet.
service-memory-limit-exceeded = Die Berechnung hat die Speichergrenze von { $size } MiB überschritten.
service-sample-invalid = Mit diesen Werten ist die Aufgabe ungültig: { $path }: { $reason }
service-compiling = Kompilieren von Rechencode, den dieser Auftrag als erster braucht

# Batches

service-number-not-finite = Dies muss eine endliche Zahl sein.
service-batch-kind-varied = Alle Aufgaben eines Stapels haben dieselbe Art; `kind` kann nicht variiert werden.
service-field-varied-twice = Dieses Feld wird bereits variiert, ganz oder zum Teil.
service-hypercube-needs-samples = Ein lateinischer Hyperwürfel braucht `samples`, die Zahl der Aufgaben.
service-sampling-without-samples = Bei { $sampling } legen die Werte die Zahl der Aufgaben fest; `samples` weglassen.
service-sampling-without-seed = Bei { $sampling } wird nichts zufällig gezogen; `seed` weglassen.
service-hypercube-without-count = Ein lateinischer Hyperwürfel hat einen Wert je `samples`; `count` weglassen.
service-count-missing = `count` angeben, die Zahl der Werte.
service-zip-counts-differ = Bei zip brauchen alle Felder gleich viele Werte; das erste Feld hat { $count }.
service-batch-too-large = Diese Werte ergeben { $count } Aufgaben; ein Stapel kann höchstens { $most } haben.
service-batch-values-too-long =
    Die Werte von { $count } Aufgaben sind größer als { $size } MiB; weniger oder kürzere Werte angeben.
service-metric-unknown = Unbekannte Kenngröße; diese Art hat { $metrics }.
service-metric-twice = Diese Kenngröße steht zweimal da; sie nur einmal angeben.
service-value-is = Der Wert ist { $value }.
service-values-or-range = entweder values angeben oder from und to
service-batch-progress = { $done } von { $total }
service-batch-unknown = Kein Stapel hat diese Kennung.
service-batch-metric-unknown = Unbekannte Kenngröße; dieser Stapel hat { $metrics }.
service-batch-without-metrics = Unbekannte Kenngröße; dieser Stapel hat keine.
service-metric-weighed-twice = { $metric } ist zweimal genannt; die Größe nur einmal minimieren oder maximieren.
service-metric-missing = Eine Kenngröße nennen, die minimiert (`least`) oder maximiert (`greatest`) wird.
service-index-expected = Index eines Listenelements erwartet, gezählt ab 0; angegeben ist { $step }.
service-element-missing = Element { $index } gibt es nicht; die Liste hat die Länge { $length }.
service-place-without-members = Der Wert vor { $step } ist weder ein Objekt noch eine Liste.
service-about-malformed-request = Die empfangenen Daten sind keine HTTP-Anfrage. Eine HTTP-Bibliothek verwenden.
service-about-incomplete-body = Die Verbindung endete, bevor der ganze Inhalt da war. Die Anfrage noch einmal senden.
service-about-malformed-json = Der Inhalt ist kein gültiges JSON oder zu tief geschachtelt. `errors` nennt die Stelle.
service-about-malformed-drawing = Die Datei lässt sich nicht als Zeichnung, Tabelle oder Bild lesen.
service-about-http-error = Die Anfrage verletzt HTTP. Der Status sagt, wie.
service-about-unauthorized = Der Dienst hat API-Schlüssel, und die Anfrage hat keinen oder einen ungültigen. `Authorization: Bearer` mit einem Schlüssel senden.
service-about-foreign-host = Der Dienst hat keine API-Schlüssel und beantwortet deshalb nur Anfragen an den eigenen Rechner. Der Betreiber kann einen Schlüssel anlegen.
service-about-not-found = Unter dieser Adresse gibt es für diesen Schlüssel nichts. Kennungen anderer Mandanten werden ebenso beantwortet.
service-about-method-not-allowed = Die Adresse gibt es, aber nicht für diese Methode. Der Kopf `Allow` nennt die Methoden.
service-about-request-timeout = Die Anfrage kam nicht rechtzeitig vollständig an. Noch einmal senden.
service-about-idempotency-key-reused = Der `Idempotency-Key` gehört zu einer früheren Anfrage mit anderem Inhalt. Für eine neue Anfrage einen neuen Schlüssel nehmen.
service-about-part-of-batch = Der Auftrag ist eine der Aufgaben eines Stapels, der sich nur als Ganzes entfernen lässt.
service-about-no-result = Der Auftrag hat kein Ergebnis: Er ist unfertig, gescheitert oder abgebrochen. Sein Status steht im Auftrag.
service-about-no-drawing = Der Entwurf lässt sich in den Grenzen des Dienstes nicht zeichnen.
service-about-no-motion = Der Entwurf hat keine Bewegung, die sich berechnen ließe.
service-about-no-forces = Die Aufgabe hat kein `dynamics`, und die Anfrage gibt keines an. Eigene Massen und Lasten senden.
service-about-no-simulation = Der Entwurf lässt sich für dieses Simulationsprogramm nicht schreiben.
service-about-no-parts = Der Entwurf lässt sich mit diesen Angaben nicht in Teile zerlegen. `detail` sagt, warum.
service-about-body-too-large = Der Inhalt ist größer, als der Dienst annimmt. Der Betreiber setzt die Grenze mit `MECHSYNTH_MAX_BODY_BYTES`.
service-about-unsupported-media-type = Die Operation nimmt keinen Inhalt mit diesem `Content-Type` an.
service-about-invalid-request = Ein Parameter, ein Kopf oder ein Feld ist ungültig. `errors` nennt jede Stelle und was dort erwartet wird.
service-about-invalid-problem = Die Aufgabe ist ungültig oder widerspricht sich. `errors` nennt jede Stelle und was dort erwartet wird.
service-about-invalid-mechanism = Das Getriebe oder seine Bewegung ist ungültig oder überschreitet die Grenzen einer Analyse. `errors` nennt jede Stelle.
service-about-invalid-drawing = Die Datei ist lesbar, aber nicht brauchbar. `errors` nennt ihre Elemente.
service-about-rate-limited = Der Schlüssel hat zu viele Anfragen gesendet. Die Sekunden in `Retry-After` abwarten.
service-about-head-too-large = Adresse und Köpfe der Anfrage sind zusammen zu groß.
service-about-gone = Der Client hat die Verbindung getrennt. Nur Protokoll und Metriken haben diesen Fehler.
service-about-internal-error = Der Dienst hat einen Fehler. Das Protokoll des Betreibers hat Näheres unter der `X-Request-ID` der Antwort.
service-about-worker-died = Der Rechenprozess des Auftrags ist zu oft abgestürzt; der Auftrag wurde aufgegeben.
service-about-no-cad = Der Dienst kann keine Körper erzeugen: Er läuft ohne den Zusatz `cad`.
service-about-busy = Der Dienst ist mit anderen Anfragen beschäftigt oder bereitet sich nach dem Start noch vor. Nach den Sekunden in `Retry-After` wieder versuchen.
service-about-queue-full = Der Mandant hat so viele wartende Aufträge, wie der Dienst annimmt. Wieder versuchen, wenn einige beendet sind.
service-about-too-many-listeners = Zu viele Clients des Mandanten folgen gleichzeitig Aufträgen. Einige der Verbindungen schließen.
service-about-store-unavailable = Die Datenbank antwortet nicht. Gespeicherte Aufträge sind sicher. Nach den Sekunden in `Retry-After` wieder versuchen.
service-about-not-ready = Der Dienst kann zurzeit keine Aufträge annehmen oder rechnen. `detail` sagt, was fehlt.
service-about-timeout = Der Auftrag dauerte länger, als der Dienst erlaubt. Weniger verlangen oder den Betreiber um eine höhere Grenze bitten.
service-about-out-of-memory = Der Auftrag brauchte mehr Speicher, als der Dienst erlaubt. Weniger verlangen oder den Betreiber um eine höhere Grenze bitten.
