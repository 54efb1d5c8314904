### Progress

dwell-progress-refining-starts = Verfeinerung { $next } von höchstens { $all }
