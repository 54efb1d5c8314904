# Remarks on a design without manufacturing results, or with some only

manufacture-type-not-supported = not built for { $mechanism }
manufacture-not-assembled-at-reference = the linkage cannot be assembled in its reference configuration
manufacture-not-assembled-at-targets = the linkage cannot be assembled at every target
manufacture-toggle-at-target = the linkage is at a toggle at a target
manufacture-toggle-within-clearances = within the clearances of its pins the linkage reaches a toggle at a target
