### Progress

function-progress-sixbars = Sechsgelenk { $next } von { $all } wird geprüft
