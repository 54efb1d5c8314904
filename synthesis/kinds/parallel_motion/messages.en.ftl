### Progress

parallel_motion-progress-driving-sixbars = driving sixbars
