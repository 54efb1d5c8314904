### Progress

path-progress-sixbars-driven = { $done } von { $all } Sechsgelenken durchgefahren
path-progress-linkages-verified = { $done } von { $all } Getrieben geprüft
path-progress-driving-linkage = Getriebe { $next } von { $all } wird durchgefahren
path-progress-linkages-driven = { $done } von { $all } Getrieben durchgefahren
path-progress-real-linkages-verified = { $done } von { $all } reellen Getrieben geprüft
