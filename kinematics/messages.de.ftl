# Eine Abmessung, die kein Getriebe haben kann. $name ist ein Feld oder einer der Namen unten, $expected eine der
# Forderungen unten, $value der angegebene Wert.
kinematics-dimension-required = { $name }: gefordert { $expected }, angegeben { $value }

# Forderungen an beliebige Abmessungen, nach „gefordert“.
kinematics-at-least = mindestens { $least }
kinematics-count-at-least = eine Anzahl von mindestens { $least }
kinematics-positive = positiv
kinematics-positive-and-finite = positiv und endlich
kinematics-sign = +1 oder −1
kinematics-zero-or-more = null oder größer

# Namen von Abmessungen der Zahnräder.
kinematics-addendum-and-dedendum = Kopf- und Fußhöhe der Zähne
kinematics-bodies-of-mesh = Körper eines Eingriffs
kinematics-centre-distance = Achsabstand
kinematics-internal-gear = Zähnezahl eines Hohlrads
kinematics-module-and-pressure-angle = Modul und Eingriffswinkel
kinematics-teeth-and-normal-module = teeth und normal_module
kinematics-tip-and-root-radius = Kopf- und Fußkreisradius
kinematics-worm-set = Schneckenradsatz

# Forderungen an Zahnräder und ihre Stufen, nach „gefordert“.
kinematics-above-0-to-1 = größer als 0 und höchstens 1
# $kind: external, internal, helical, bevel oder worm
kinematics-absent-in-stage = keine in einer Stufe der Art { $kind }
kinematics-absent-with-idlers = keine in einer Stufe mit Zwischenrädern
kinematics-at-least-one-stage = mindestens eine
kinematics-base-circles-apart = so groß, dass sich die Grundkreise nicht überschneiden
kinematics-below-worm-lock = kleiner als der Wert, bei dem die Reibung die Schnecke sperrt
kinematics-between-0-and-half-pi = zwischen 0 und π/2
kinematics-between-0-and-pi = zwischen 0 und π
# $bodies: Namen, durch Kommas getrennt
kinematics-body-of-train = einer von { $bodies }
kinematics-cones-not-flat = so gewählt, dass beide Teilkegelwinkel kleiner als 90° sind
kinematics-depth-of-rack-tooth = nicht tiefer als die Spitze des Zahnstangenzahns
kinematics-efficiency-of-meshes = eine Zahl oder { $count } für die Eingriffe
kinematics-external-gear = ein außenverzahntes Rad
kinematics-known-for-every-body = für jeden Körper bekannt
kinematics-less-than-right-angle = kleiner als 90°
# $members: Namen, durch Kommas getrennt
kinematics-load-on-member = an einem der Glieder { $members }
kinematics-more-teeth-than-pinion = größer als die des Ritzels
kinematics-pinion-not-larger = positiv, am Ritzel nicht größer als am Rad
kinematics-positive-numbers = aus positiven Zahlen
kinematics-rising-speeds = positiv, die höchste größer als die niedrigste
kinematics-same-on-both-gears = an beiden Rädern gleich
kinematics-stages-of-gear-pairs = Folgen von mindestens einem Räderpaar
# $gears: Namen, durch Kommas getrennt
kinematics-teeth-of-gears = angegeben für genau { $gears }
kinematics-three-different-bodies = drei verschiedene
kinematics-tooth-bent-by-load = ein Zahn, den seine Last biegt
kinematics-tooth-with-section = ein Zahn mit einem Querschnitt unterhalb seiner Last
