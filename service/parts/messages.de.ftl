## Entry point and files

parts-unknown-part = Unbekanntes Teil. Teile dieses Entwurfs: { $parts }.
parts-no-such-file = Das Teil „{ $part }“ hat keine Datei im Format { $format }.
parts-input-field = Der Antrieb dieses Mechanismus wird mit `{ $field }` angegeben.
parts-rotor-without-shape = die Antwort zu einem Rotor enthält Massen, Radien und Winkel, mit denen sich ein Rotor auswuchten lässt, aber nicht seine Gestalt; nehmen Sie `designs/{"{"}n{"}"}.csv` oder `.dxf`, die diese enthalten, um den vorhandenen Rotor auszuwuchten
parts-engine-without-widths = die Antwort zu einem Motor enthält Kurbelwinkel, eine Zündfolge und Ausgleichsmassen, aber keinen Durchmesser und keine Breite einer Bohrung, eines Zapfens oder einer Wange; nehmen Sie `designs/{"{"}n{"}"}.csv` oder `.dxf`, die diese enthalten, oder fordern Sie die Teile eines Zylinders als Schubkurbel vom `kind` `motion` an
parts-not-available = Teile dieser Art von Mechanismus gibt es nicht: { $reason }.
parts-field-without-meaning = Teile dieser Art von Mechanismus haben kein `{ $field }`; lassen Sie es weg.

## Sizes

parts-clearance-out-of-range = Das Spiel muss bei Bolzen von { $pin } { $unit } zwischen { $smallest } und { $largest } { $unit } liegen.
parts-thickness-out-of-range = Die Dicke muss bei Bolzen von { $pin } { $unit } zwischen { $smallest } und { $largest } { $unit } liegen.

## Search for sizes that fit

parts-links-narrow-for-pins = Glieder mit Bolzen von { $pin } { $unit } müssen mindestens { $width } { $unit } breit sein, damit eine Wand von einem Viertel des Bolzens bleibt.
parts-links-narrow-for-runner = Glieder mit einem Gleitstück auf Bolzen von { $pin } { $unit } müssen mindestens { $width } { $unit } breit sein, damit eine Wand von einem Viertel des Bolzens bleibt.
parts-links-narrow-for-blocks = Glieder mit Gleitsteinen auf Bolzen von { $pin } { $unit } müssen mindestens { $width } { $unit } breit sein, damit eine Wand von einem Viertel des Bolzens bleibt.
parts-links-narrow-for-shafts = Glieder mit Passfedernuten für Wellen von { $pin } { $unit } müssen mindestens { $width } { $unit } breit sein, damit eine Wand von einem Viertel des Bolzens bleibt.
parts-mechanism-too-large = Der Mechanismus ist in diesem Maßstab { $size } m groß; Teile werden bis { $largest } m gefertigt. Verwenden Sie höchstens den Maßstab { $scale }.
parts-pin-not-available = Bolzen von { $pin } { $unit } gibt es nicht; verwenden Sie { $smallest } bis { $largest } { $unit }.
parts-links-too-wide = Glieder müssen schmaler als { $largest } { $unit } sein, die größte Abmessung von Teilen.
parts-links-do-not-fit = Glieder mit { $width } { $unit } Breite passen nicht: { $reason }.
parts-only-narrower-fit = Schmalere Glieder passen, diese aber in keinem zulässigen Maßstab (bis { $scale }).
parts-no-links-fit = Auch schmalere Glieder passen nicht: Der Mechanismus lässt sich nicht in Ebenen bauen.
parts-larger-scale-or-narrower-fits = Diese Größen passen ab dem Maßstab { $least }; im Maßstab { $scale } passt eine Breite von { $width } { $unit }, mit Bolzen, Dicke und Spiel im gleichen Verhältnis.
parts-larger-scale-fits = Diese Größen passen ab dem Maßstab { $least }.
parts-walls-too-thin = { $part } hat zu dünne Wände um seine Bohrungen
parts-collide-at-place = { $first } und { $second } kollidieren beim Antriebsweg { $place }
parts-collide-at-angle = { $first } und { $second } kollidieren beim Antriebswinkel { $angle }°

## Names of links, gears, pins and materials

parts-sheet = Blech
parts-steel = Stahl
parts-aluminium = Aluminium
parts-bronze = Bronze
parts-arm = Hebel
parts-base = Grundplatte
parts-second-base = zweite Grundplatte
parts-cam = Kurvenscheibe
parts-carrier = Steg
parts-coupler = Koppel
parts-crank = Kurbel
parts-driven-crank = getriebene Kurbel
parts-follower = Eingriffsglied
parts-idler = Zwischenrad
parts-input-link = Antriebsglied
parts-link = Glied
parts-output-link = Abtriebsglied
parts-pawl = Sperrklinke
parts-pawl-pin = Klinkenbolzen
parts-roller-pin = Rollenbolzen
parts-planet = Planet
parts-long-planet = langer Planet
parts-short-planet = kurzer Planet
parts-post = Säule
parts-ring = Hohlrad
parts-rocker = Schwinge
parts-roller = Rolle
parts-sun = Sonne
parts-large-sun = große Sonne
parts-small-sun = kleine Sonne
parts-upright = Ständer
parts-wheel = Rad
parts-gear-of-link = Zahnrad von { $name }
parts-lower-plate-of-link = { $name }, untere Platte
parts-pin = Bolzen { $name }
parts-upper-plate-of-link = { $name }, obere Platte
parts-numbered = { $name } { $number }
parts-part-in-sentence = Teil „{ $name }“

## Pins, keys and distance pieces

parts-pin-cap = Kappe für { $pin }, aufgepresst oder aufgeklebt
parts-retaining-ring = Sicherungsring für { $pin }
parts-washer = Scheibe
parts-spacer = Distanzring
parts-key = Passfeder

## Linkages

parts-teeth-of-wheel = { $teeth } ({ $wheel })
parts-linkage-gear-teeth = Zähnezahlen: { $teeth }; Modul { $module } mm, wie es der Abstand der Gestellpunkte erfordert.
parts-linkage-gears-keyed = Die Räder und ihre Glieder sitzen mit Passfedern auf einer Welle; ihr Winkel zueinander ist die Phase des Getriebes.
parts-divided-link = Das Glied { $link } besteht aus zwei Platten, je einer auf beiden Seiten der zweiten Grundplatte. Beide sitzen mit Passfedern auf der Welle { $pivot }, die sich in dieser Grundplatte dreht, sodass sie sich gemeinsam bewegen. Setzen Sie die untere Platte auf die Welle, bevor Sie diese Grundplatte darüberlegen.
parts-input-on-shaft = Das Antriebsglied sitzt mit einer Passfeder auf der Welle { $pivot }, die von oben eingesetzt wird und für den Antrieb unter die Grundplatte ragt.
parts-wheel-with-teeth = { $wheel }, { $teeth } Zähne
parts-block = Gleitstein bei { $joint }
parts-shaft-at-joint = Welle { $joint }
parts-ratio-not-exact = Keine Räder mit bis zu { $largest } Zähnen haben genau die Übersetzung { $ratio }; mit einer angenäherten würde sich die Phase der Glieder verschieben.
parts-ratio-needs-too-many-teeth = Räder mit der Übersetzung { $ratio } brauchen { $first } und { $second } Zähne bei mindestens { $smallest } am kleineren; höchstens { $largest } sind möglich.
parts-needs-divided-link = Der Mechanismus lässt sich weder mit Wellen auf einer Grundplatte noch zwischen zweien in Ebenen bauen. Lassen Sie `shafts` weg: Dann wird sein Glied { $link } in zwei Platten auf einer Welle geteilt, auf beiden Seiten der zweiten Grundplatte.
parts-does-not-assemble = Die Abmessungen dieses Entwurfs ergeben keinen montierbaren Mechanismus.
parts-too-many-gear-pairs = Teile gibt es für Koppelgetriebe mit höchstens einem Räderpaar, das vom Antrieb getrieben sein muss.
parts-fits-on-neither-bases = { $one }; mit zwei Grundplatten: { $two }
parts-clearance-exceeds-tooth-play = das Spiel, zugleich das der Zähne, überschreitet { $share } von deren Modul
parts-not-separated-at-place = keine Anordnung in Ebenen trennt { $first } und { $second } beim Antriebsweg { $place }
parts-not-separated-at-angle = keine Anordnung in Ebenen trennt { $first } und { $second } beim Antriebswinkel { $angle }°
parts-used-range-impossible = Der Mechanismus kann sich nicht durch den genutzten Bereich dieses Entwurfs bewegen.
parts-cannot-be-driven = Der Mechanismus lässt sich nicht antreiben: { $reason }.
parts-not-assembled-over-motion = Der Mechanismus lässt sich nicht über die ganze Bewegung montieren.
parts-input-out-of-range = Der Antrieb muss zwischen { $low } und { $high } liegen.

## Cams

parts-groove-with-step = Der Weg des Eingriffsglieds springt; eine Nut kann jedoch keine Stufe haben.
parts-roller-too-narrow = die Rolle ist nicht breiter als die Sicherung ihres Bolzens
parts-groove-leaves-thin-wall = die Nut, so tief wie die Rolle dick ist, lässt eine zu dünne Wand um die Welle
parts-groove-undercut = der Nutgrund liegt so nah an der Achse, dass die Rolle ihre eigene Wand wegschneiden würde
parts-parts-collide = Die Teile passen nicht: { $first } und { $second } kollidieren.
parts-groove-milling = Die Nut wird mit einem Fräser gefräst, der so breit ist wie die Rolle mit ihrem Spiel, oder gedruckt; die Zeichnung der Trommel ist ihre Abwicklung, von außen gesehen.
parts-glue-uprights = Kleben oder pressen Sie die Füße der Ständer in die Grundplatte.
parts-runner = Gleitstück in der Führung
parts-guide-pin = Führungsbolzen { $number }
parts-grooved-barrel = Trommel mit Nut
parts-camshaft = Welle der Kurvenscheibe
parts-cam-with-edge = Die Kurvenscheibe hat dort eine Kante, wo die Geschwindigkeit des Eingriffsglieds springt; eine solche Kontur lässt sich nicht schneiden.
parts-cam-bend-too-sharp = Die Kurvenscheibe hat eine Krümmung, der keine glatte Kurve auf { $deviation } mm genau folgt.
parts-fits-neither-above-nor-below = { $above }; mit dem Eingriffsglied unter der Kurvenscheibe: { $below }
parts-dowel-pin = Passstift { $number }
parts-cam-back = Rückplatte der Kurvenscheibe
parts-groove-inner-wall = Kurvenscheibe, Innenwand der Nut
parts-groove-outer-wall = Außenwand der Nut
parts-grooved-cam = Kurvenscheibe mit Nut
parts-follower-arms-angle = Der Winkel zwischen den beiden Armen des Eingriffsglieds lässt keine einteilige Platte zu.
parts-pivot-pin = Lagerbolzen
parts-camshaft-protrudes = Die Welle der Kurvenscheibe ragt für den Antrieb unter die Grundplatte; alle Teile, die sich mit ihr drehen, sitzen mit Passfedern auf ihr.
parts-follower-needs-force = Eine Feder oder ein Gewicht muss das Eingriffsglied an der Kurvenscheibe halten; das gehört nicht zu den Teilen.

## Geneva drives and ratchets

parts-geneva-with-drag-link = Teile gibt es nur für Malteserkreuzgetriebe, deren Kurbel der Antrieb ist; die Koppel dieser Doppelkurbel würde mit den Wellen auf beiden Seiten kollidieren.
parts-slots-do-not-fit = Schlitze mit diesem Spiel passen nicht in das Rad
parts-locking-disc-too-small = die Sperrscheibe reicht dort, wo das Rad an ihr vorbeiläuft, { $reach } { $unit } von ihrer Achse, die Bohrung für die Kurbelwelle mit ihrer Passfeder braucht aber { $needed }; verwenden Sie eine dünnere Kurbelwelle oder einen größeren Achsabstand
parts-geneva-input = Der Antrieb ist die Kurbel; beim Antriebswinkel 0 tritt eine Rolle in einen Schlitz ein.
parts-geneva-keyed = Alle drehenden Teile sitzen mit Passfedern auf ihren Wellen, die über die Grundplatten hinausragen.
parts-locking-disc = Sperrscheibe
parts-wheel-shaft = Radwelle
parts-crankshaft = Kurbelwelle
parts-wheel-plate = Platte des Rads
parts-wheel-ring = Rad, ringförmig
parts-locking-crescent = Sperrsichel
parts-crescent-pin = Sichelbolzen { $number }
parts-pawl-overlaps-nose = das runde Ende einer Sperrklinke um ihren Drehpunkt würde ihre Nase überdecken
parts-ratchet-wheel = Sperrrad
parts-ratchet-input = Der Antrieb ist der Winkel des Rads gegen den Uhrzeigersinn, ab der Raststelle der ersten Sperrklinke.
parts-pawls-need-force = Federn oder Gewichte müssen die Sperrklinken auf die Zähne drücken; sie gehören nicht zu den Teilen.
parts-ratchet-keyed = Das Rad sitzt mit einer Passfeder auf seiner Welle, die unter die Grundplatte ragt.
parts-too-few-teeth-for-pawl = Das Rad hat zu wenige Zähne für eine einteilige Sperrklinke: Ihre Nase würde mit dem Zahn dahinter kollidieren.
parts-parts-collide-at-angle = Die Teile passen nicht: { $first } und { $second } kollidieren beim Antriebswinkel { $angle }°.
parts-shell-wall-beside-slot = die Schale ist so dick, dass die Wand zwischen Schlitz und Sperrmulde an ihrer Innenseite zu dünn ist
parts-shell-wall-between-slots = die Schale ist so dick, dass die Wand zwischen ihren Schlitzen an ihrer Innenseite zu dünn ist
parts-wheel-shaft-too-thick = die Welle des Rads ist dicker als das Rad
parts-hub-between-slots = Nabe und Welle des Rads passen nicht zwischen die Enden der Schlitze
parts-cap-around-crankshaft = die Sperrkappe passt nicht um das Ende der Kurbelwelle
parts-roller-pin-beside-crankshaft = der Rollenbolzen passt in der Kurbel nicht neben die Kurbelwelle
parts-hemisphere-wheel = Rad, eine Halbkugel
parts-crank-with-cap = Kurbel mit Sperrkappe
parts-spherical-wheel-dimensions = Das Rad ist eine Schale von { $inner } bis { $outer } mm Durchmesser; Schlitze, { $width } mm breit, bis { $slot }° über dem Rand, und Mulden von { $hollow }° werden mit Werkzeugen gefräst, die zu seinem Mittelpunkt zeigen.
parts-spherical-crank-dimensions = Pressen oder kleben Sie den Rollenbolzen in die Bohrung der Kurbel, { $angle }° zu deren Achse; er zeigt zum Mittelpunkt. Die Sperrkappe umfasst { $cap }° und endet { $offset } mm vor der Achse.
parts-spherical-wheel-drawing = Die Zeichnung des Rads zeigt seine Außenfläche nach Azimut und Breite, beide mal dem Radius: maßstäblich längs der Meridiane und am Rand.
parts-spherical-input = Der Antrieb ist die Kurbel; beim Antriebswinkel 0 tritt die Rolle in einen Schlitz ein.
parts-glue-bearing-plates = Kleben oder verkeilen Sie die Zapfen der Lagerplatten in den Schlitzen der Grundplatte.

## Flywheels

parts-flywheel-too-large = Das Schwungrad ist in diesem Maßstab etwa { $size } m groß; Teile werden bis { $largest } m gefertigt. Verwenden Sie höchstens den Maßstab { $scale }.
parts-density-in-si = { $density } kg/m³
parts-density = Dichte { $density }
parts-units-of-mass = Masseneinheiten
parts-shaft-not-available = Wellen von { $bore } { $unit } gibt es nicht; verwenden Sie { $smallest } bis { $largest } { $unit }.
parts-no-hub-within-rim = Eine Bohrung von { $bore } { $unit } lässt im Kranz keinen Platz für eine Nabe; verwenden Sie höchstens { $largest } { $unit }.
parts-no-hub-in-disc = Eine Bohrung von { $bore } { $unit } lässt in der Scheibe keinen Platz für eine Nabe; verwenden Sie höchstens { $largest } { $unit }.
parts-flywheel = Schwungrad
parts-flywheel-shaft = Schwungradwelle
parts-flywheel-disc-difference = Die Scheibe der Antwort mit { $mass } { $unit } ist massiv: Bohrung und Nut nehmen ihr { $removed } { $unit } und einen Anteil von { $share } ihres Trägheitsmoments; die Welle und die Passfeder, die beide ausfüllen, drehen sich mit.
parts-arms-add-mass = Schon der Kranz allein hat die Masse der Antwort, { $mass } { $unit }, und ihr Trägheitsmoment; Nabe und { $count } Arme kommen mit { $more } { $unit } hinzu, sodass die Drehzahl weniger schwankt als zugelassen.
parts-plate-adds-mass = Schon der Kranz allein hat die Masse der Antwort, { $mass } { $unit }, und ihr Trägheitsmoment; die Platte darin kommt mit { $more } { $unit } hinzu, sodass die Drehzahl weniger schwankt als zugelassen.

## Gear trains

parts-bevel-face-too-wide = Die Zahnbreite von Kegelrädern ist auf die halbe Teilkegellänge begrenzt, { $largest } { $unit }.
parts-gears-cannot-be-cut = Die Räder lassen sich nicht verzahnen: { $reason }.
parts-input-shaft = Antriebswelle
parts-output-shaft = Abtriebswelle
parts-bevel-driven = Kegelrad, getrieben, { $teeth } Zähne
parts-bevel-driver = Kegelrad, treibend, { $teeth } Zähne
parts-bevel-dimensions = Achsenwinkel { $angle }°; Teilkegellänge { $distance } mm, Zahnbreite { $width } mm; Modul { $module } mm am großen Ende.
parts-bevel-driver-sizes = Treibendes Rad: { $teeth } Zähne, Teilkegel { $pitch }°, Kopfkegel { $tip }°, Fußkegel { $root }°, Kopfkreisdurchmesser { $diameter } mm; Einbaumaß von der Kegelspitze bis zum Ende der Nabe { $distance } mm.
parts-bevel-driven-sizes = Getriebenes Rad: { $teeth } Zähne, Teilkegel { $pitch }°, Kopfkegel { $tip }°, Fußkegel { $root }°, Kopfkreisdurchmesser { $diameter } mm; Einbaumaß von der Kegelspitze bis zum Ende der Nabe { $distance } mm.
parts-held-by-lower-plate = Die { $shaft } ist nur in der unteren Platte gelagert.
parts-held-by-upper-plate = Die { $shaft } ist nur in der oberen Platte gelagert.
parts-key-of-shaft = Passfeder der { $shaft }
parts-feather-key-of-shaft = Gleitfeder der { $shaft }
parts-layshaft = Vorgelegewelle
parts-main-shaft = Hauptwelle
parts-axle-of-idler = Achse des Zwischenrads
parts-gear-on-input-shaft = { $pair }, auf der Antriebswelle, { $teeth } Zähne
parts-gear-on-layshaft = { $pair }, auf der Vorgelegewelle, { $teeth } Zähne
parts-gear-on-main-shaft = { $pair }, auf der Hauptwelle, { $teeth } Zähne
parts-gear-on-idler-axle = { $pair }, Zwischenrad, { $teeth } Zähne
parts-first-gear-direct = Die Teile werden mit eingelegtem erstem Gang gefertigt; der erste Gang dieses Getriebes ist jedoch der direkte.
parts-shafts-obstructed = Die Wellen passen nicht: Eine von ihnen oder ein Teil auf ihr ginge durch ein Rad. Versuchen Sie dünnere Wellen oder einen anderen Maßstab.
parts-first-gear-engaged = Der erste Gang ist eingelegt: Sein Rad sitzt mit einer Passfeder auf der Hauptwelle; die anderen drehen sich frei auf ihr.
parts-gearshift-not-included = Die Vorrichtung, die andere Gänge einlegt oder Antriebs- und Hauptwelle kuppelt, gehört nicht zu den Teilen.
parts-head-pair = Konstantradpaar
parts-reverse-pair = Rückwärtsgang
parts-gear-pair = Gang { $number }
parts-shafts-obstructed-in-every-arrangement = Die Wellen passen nicht: In jeder Anordnung ginge eine von ihnen oder ein Teil auf ihr durch ein Rad. Versuchen Sie dünnere Wellen oder einen anderen Maßstab.
parts-crossing-shafts-single-stage = Teile von Kegelrädern und Schnecken gibt es nur für einstufige Getriebe: Weitere Stufen brauchten Gehäuse im rechten Winkel zueinander.
parts-web-of-ring = Scheibe des Hohlrads
parts-numbered-shaft = Welle { $number }
parts-idler-axle = Zwischenradachse { $number }
parts-wheels-keyed = Die Räder sitzen mit Passfedern auf ihren Wellen; die Wellenenden, die aus den Platten ragen, sind Antrieb und Abtrieb.
parts-ring-driver = Hohlrad der Stufe { $stage }, treibend, { $teeth } Zähne
parts-gear-driver = Rad der Stufe { $stage }, treibend, { $teeth } Zähne
parts-ring-driven = Hohlrad der Stufe { $stage }, getrieben, { $teeth } Zähne
parts-gear-driven = Rad der Stufe { $stage }, getrieben, { $teeth } Zähne
parts-gear-idler = Rad der Stufe { $stage }, Zwischenrad { $number }, { $teeth } Zähne
parts-planetary-type-not-available = Teile gibt es nur für Planetengetriebe aus Stirnrädern mit einem Steg.
parts-planetary-shafts-unreachable = Antrieb und Abtrieb dieses Getriebes sind nicht beide von zwei Platten aus erreichbar.
parts-web-of-wheel = Scheibe für { $wheel }
parts-shaft-of-member = Zentralwelle ({ $member })
parts-axle-of-planet = Achse von { $planet }
parts-planetary-gears-keyed = Die Räder sitzen mit Passfedern auf ihren Wellen; Planeten drehen sich auf ihren Bolzen, Stufenplaneten zusammen mit ihnen.
parts-member-fixed-by-key = Fest steht das Glied „{ $member }“: Eine Passfeder verbindet seine Welle mit der Platte.
parts-member-is-lower-plate = Fest steht das Glied „{ $member }“: Es ist die untere Platte.
parts-member-held-by-posts = Fest steht das Glied „{ $member }“: Die Säulen halten es.
parts-input-without-shaft = Antrieb ist das Glied „{ $member }“. Es hat keine eigene Welle: Schließen Sie an seinem Kranz an.
parts-output-without-shaft = Abtrieb ist das Glied „{ $member }“. Es hat keine eigene Welle: Schließen Sie an seinem Kranz an.
parts-series-with-planetary = Teile gibt es nur für Reihen von Getrieben mit gestellfesten Achsen; diese enthält ein Planetengetriebe, dessen Wellen an Steg und Hohlrad enden. Fordern Sie die Teile jedes Getriebes einzeln an.
parts-series-with-reverted = Teile gibt es nur für Reihen ohne koaxiale Getriebe: Stufen in einer Reihe haben keine zwei Wellen auf einer Achse. Fordern Sie die Teile eines koaxialen Getriebes einzeln an.
parts-series-pressure-angles = Teile gibt es nur für Getriebe mit einheitlichem Eingriffswinkel.
parts-train-too-large = Das Getriebe ist in diesem Maßstab etwa { $size } m groß; Teile werden bis { $largest } m gefertigt. Verwenden Sie höchstens den Maßstab { $scale }.
parts-face-width-out-of-range = Die Zahnbreite muss bei einem Modul von { $module } zwischen { $smallest } und { $largest } { $unit } liegen.
parts-axle-too-close = Die Achse des Planetenrads „{ $planet }“ läuft im Abstand von { $distance } { $unit } an „{ $gear }“ vorbei, zu nah für eine Welle mit Distanzring.
parts-root-circle-too-small = Das kleinste Rad hat einen Fußkreis von { $diameter } { $unit }, zu klein für eine Welle; verwenden Sie mindestens den Maßstab { $scale }.
parts-axle-too-close-at-scale = Die Achse des Planetenrads „{ $planet }“ läuft im Abstand von { $distance } { $unit } an „{ $gear }“ vorbei, zu nah für eine Welle mit Distanzring; verwenden Sie mindestens den Maßstab { $scale }.
parts-bore-too-large = Eine Bohrung von { $bore } { $unit } mit ihrer Nut lässt eine zu dünne Wand unter den Zähnen des kleinsten Rads, dessen Fußkreis { $diameter } { $unit } misst; verwenden Sie { $thinner } { $unit }.
parts-bore-too-large-for-any = Eine Bohrung von { $bore } { $unit } mit ihrer Nut lässt eine zu dünne Wand unter den Zähnen des kleinsten Rads, dessen Fußkreis { $diameter } { $unit } misst.
parts-tooth-play-too-large = Das Spiel ist zugleich das der Zähne und darf beim Modul { $module } höchstens { $largest } { $unit } betragen.
parts-speed-out-of-range = Dieses Getriebe hat die Drehzahlen 1 bis { $count }.
parts-speed-shown = Gezeigt ist Drehzahl { $number } von { $count }, { $speed } 1/min am Abtrieb
parts-shafts-obstructed-in-some-speed = Die Wellen passen nicht: In jeder Anordnung ginge eine von ihnen oder ein Teil auf ihr bei einer Drehzahl durch ein Rad. Versuchen Sie dünnere Wellen oder einen anderen Maßstab.
parts-pair-driver = Rad der Stufe { $stage }, Paar { $pair }, treibend, { $teeth } Zähne
parts-pair-driven = Rad der Stufe { $stage }, Paar { $pair }, getrieben, { $teeth } Zähne
parts-cluster-hub = Nabe zwischen den Rädern der Stufe { $stage }, Paare { $first } und { $second }
parts-cluster = Räderblock der Stufe { $stage }, Paare { $first } und { $second }, treibend, { $lower } und { $upper } Zähne
parts-engaged-pair = Paar { $pair } der Stufe { $stage }, { $driver }/{ $driven }
parts-speed-ratio = { $speed }: { $pairs }; Antriebs- durch Abtriebsdrehzahl { $ratio }.
parts-other-speeds = Alle Drehzahlen haben dieselben Teile in anderen Stellungen; fordern Sie eine andere Drehzahl an, um sie zu sehen.
parts-cluster-positions = Ein Block aus zwei Rädern hat drei Stellungen im Abstand von { $step } mm auf seiner Gleitfeder: unteres Rad im Eingriff, neutral, oberes Rad im Eingriff. Ein einzelnes Schieberad ist in seiner unteren Stellung im Eingriff und in der oberen neutral. Bringen Sie zuerst alle anderen Blöcke der Stufe im Stillstand in die neutrale Stellung: Drehen Sie die Wellen, bis Zähne vor Lücken stehen.
parts-feather-keys-retain = Die Enden der Gleitfedern sichern die benachbarten Teile auf der Welle: Setzen Sie Distanzringe, Federn und Räder in der Reihenfolge ihrer Lage auf. Gabeln, Hebel und Rasten, die die Räder schalten, gehören nicht zu den Teilen.
parts-cluster-bonded = Die Räder eines Zweierblocks und die Nabe zwischen ihnen werden verklebt oder verschraubt; jedes Rad hat seine Passfeder, sodass die Verbindung kein Drehmoment überträgt. Zwischen die Räder passt eine Gabel.
parts-cluster-one-piece = Ein Zweierblock ist einteilig, mit der Nabe zwischen seinen Rädern, um die eine Gabel passt; seine DXF-Datei enthält nur den Umriss des größeren Rads.
parts-bearing-plate = Lagerplatte der { $shaft }
parts-rim-pin = Kranzbolzen { $number }
parts-teeth-collide = Zähne von { $first } und { $second } kollidieren mit diesem Spiel beim Antriebswinkel { $angle }°; versuchen Sie ein Spiel über { $clearance } { $unit }.
parts-worm-shaft = Schneckenwelle
parts-worm =
    { $count ->
        [one] Schnecke, { $count } Gang
       *[other] Schnecke, { $count } Gänge
    }
parts-worm-gear = Schneckenrad, { $teeth } Zähne
parts-worm-left-handed = Achsabstand der gekreuzten Wellen { $distance } mm; Steigungswinkel { $lead }°, linksgängig; Kopfkreisdurchmesser { $worm } und { $gear } mm.
parts-worm-right-handed = Achsabstand der gekreuzten Wellen { $distance } mm; Steigungswinkel { $lead }°, rechtsgängig; Kopfkreisdurchmesser { $worm } und { $gear } mm.
parts-worm-gear-cylindrical = Das Schneckenrad ist zylindrisch, mit Schrägzähnen, die den Schneckengang in einem Punkt berühren: Es überträgt die genaue Übersetzung, trägt aber weniger als ein zur Schnecke wälzgefrästes Rad.
