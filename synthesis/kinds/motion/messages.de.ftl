### Progress

motion-progress-adding-drivers = Antriebszweischläge werden ergänzt
motion-progress-driving-best-pairs = die besten Paare werden durchgefahren
