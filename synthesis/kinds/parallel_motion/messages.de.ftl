### Progress

parallel_motion-progress-driving-sixbars = Sechsgelenke werden durchgefahren
