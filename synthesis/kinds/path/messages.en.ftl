### Progress

path-progress-sixbars-driven = { $done } of { $all } sixbars driven
path-progress-linkages-verified = { $done } of { $all } linkages verified
path-progress-driving-linkage = driving linkage { $next } of { $all }
path-progress-linkages-driven = { $done } of { $all } linkages driven
path-progress-real-linkages-verified = { $done } of { $all } real linkages verified
