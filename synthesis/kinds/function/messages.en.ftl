### Progress

function-progress-sixbars = verifying { $next } of { $all } sixbars
