### Progress

motion-progress-adding-drivers = adding driver dyads
motion-progress-driving-best-pairs = driving the best pairs
