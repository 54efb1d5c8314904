### Progress

dwell-progress-refining-starts = refining { $next } of at most { $all }
