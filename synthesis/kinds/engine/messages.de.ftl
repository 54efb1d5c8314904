# Errors of the statement

engine-rod-choice = genau eines von rod und rod_ratio angeben
engine-rod-too-short = die Pleuelstange muss länger als der Kurbelradius sein
engine-rod-too-long = die Pleuelstange ist mehr als { $ratio }-mal so lang wie der Kurbelradius
engine-rod-center-beyond-pin = liegt jenseits des Kolbenbolzens
engine-speed-missing = Kräfte von Massen und Gas brauchen eine Drehzahl
engine-bore-missing = der Gasdruck wirkt auf die Kolbenfläche; `bore` angeben
engine-flywheel-without-torque = ein Schwungrad glättet das Drehmoment; masses oder pressure angeben

# Errors of the layout, its throws and its firing

engine-vee-angle-choice = vee und w brauchen den Winkel zwischen ihren Bänken; andere Anordnungen haben keinen
engine-pins-of-one-bank = nur Anordnungen mit mehreren Bänken können für jeden Zylinder einen eigenen Kurbelzapfen haben
engine-banks-not-filled = { $cylinders } Zylinder füllen { $banks } Bänke nicht; für pins `own` angeben
engine-throw-list-length =
    { $count ->
        [one] ein Wert erwartet, einer je Kröpfung
       *[other] { $count } Werte erwartet, einer je Kröpfung
    }
engine-throws-of-further-layouts = die Kröpfungen weiterer Anordnungen werden gesucht; weglassen
engine-firing-order-incomplete = jeder der Zylinder 1 bis { $count } einmal erwartet
engine-firing-angle-count = für jeden Zylinder von firing_order ein Winkel erwartet
engine-nothing-to-find = die Kröpfungen sind gegeben, es gibt also nichts zu suchen; dieses Feld weglassen
engine-too-many-combinations = { $combinations } Kombinationen von { $count } Kröpfungen für { $layout } sind zu viele zum Vergleichen

# Summaries

engine-none-passed = Kein Motor hat seine Prüfungen bestanden.
engine-fires-evenly =
    { $layout ->
        [inline] Der Reihenmotor zündet gleichmäßig in der Folge { $order }.
        [vee] Der V-Motor zündet gleichmäßig in der Folge { $order }.
        [w] Der W-Motor zündet gleichmäßig in der Folge { $order }.
        [opposed] Der Boxermotor zündet gleichmäßig in der Folge { $order }.
       *[radial] Der Sternmotor zündet gleichmäßig in der Folge { $order }.
    }
engine-fires-unevenly =
    { $layout ->
        [inline] Der Reihenmotor zündet ungleichmäßig (Abstände unterscheiden sich um { $difference }°) in der Folge { $order }.
        [vee] Der V-Motor zündet ungleichmäßig (Abstände unterscheiden sich um { $difference }°) in der Folge { $order }.
        [w] Der W-Motor zündet ungleichmäßig (Abstände unterscheiden sich um { $difference }°) in der Folge { $order }.
        [opposed] Der Boxermotor zündet ungleichmäßig (Abstände unterscheiden sich um { $difference }°) in der Folge { $order }.
       *[radial] Der Sternmotor zündet ungleichmäßig (Abstände unterscheiden sich um { $difference }°) in der Folge { $order }.
    }
engine-unbalanced = Nach Gegengewichten an der Kurbelwelle nicht ausgeglichen: { $parts }.
engine-balanced = Mit Gegengewichten an der Kurbelwelle ist bis zur zweiten Ordnung alles ausgeglichen.
engine-none-fires-evenly = Keine Anordnung dieser Kröpfungen zündet gleichmäßig; mit throw_angles werden ungleichmäßige verglichen.
engine-arrangements = Anordnungen der Kröpfungen: { $count }.
engine-arrangements-compared = Anordnungen der Kröpfungen: { $count }; verglichen wurden { $compared } symmetrische.
engine-even-arrangements = Anordnungen der Kröpfungen mit gleichmäßiger Zündung: { $count }.
engine-even-arrangements-compared = Anordnungen der Kröpfungen mit gleichmäßiger Zündung: { $count }; verglichen wurden { $compared } symmetrische.

# Progress

engine-analysing = Untersuchung läuft
engine-arranging-throws = die Kröpfungen der Anordnung { $number } werden angeordnet
engine-analysing-best = die besten werden untersucht
