# Errors of the statement

spring_balancing-nothing-to-balance = there is nothing to balance: give gravity with masses of the links, or a load
spring_balancing-not-a-link = not a link; the links are { $links }
spring_balancing-ends-on-one-link = a spring acts between two links; both of its ends are on { $link }
spring_balancing-end-too-far = too far from the linkage
spring_balancing-friction-not-supported = the best springs can only be computed without friction; omit it

# Errors of a requested spring

spring_balancing-end-place-choice = give exactly one of point and within
spring_balancing-ends-or-links = give the ends of a spring, or the links of a torsion spring
spring_balancing-fields-of-other-type = not applicable to this type of spring: { $fields }
spring_balancing-value-and-limits-given = give either { $field } or its limits
spring_balancing-minimum-above-maximum = { $minimum } must not be above { $maximum }
spring_balancing-free-angles-excluded = the limits of the free angle exclude all; the default limit is ten turns
spring_balancing-preload-limit-too-small = max_preload must not be below preload
spring_balancing-lengths-excluded = min_length must be below max_length
spring_balancing-compression-spring-form = a compression spring needs a free length, and has no preload
spring_balancing-free-length-unbounded = unbounded: the free length could grow while the rate falls; give max_free_length
spring_balancing-diameter-not-applicable = only a compression spring has a diameter, to check buckling

# Summaries

spring_balancing-none-found = No design found.
spring_balancing-mechanism-not-held = The mechanism cannot be held over this motion.
spring_balancing-drive-zero-already = The drive is zero without springs; there is nothing to balance.
spring_balancing-no-springs-within-limits = None exists: no such springs keep their limits over this motion.
spring_balancing-exact = The springs balance the linkage exactly: the drive is zero over the motion.
spring_balancing-exact-with-constant-energy = The springs balance the linkage exactly: the drive is zero and the potential energy constant over the motion.
spring_balancing-best-found = The springs reduce the drive to { $value } of its unbalanced value. This is the best found, not a proven minimum.
spring_balancing-proven-minimum = The springs reduce the drive to { $value } of its unbalanced value; no such springs reduce it below { $bound }.
spring_balancing-bounded-minimum = The springs reduce the drive to { $value } of its unbalanced value; no such springs reduce it below { $bound }. The values in between are undecided.

# Warnings

spring_balancing-positions-not-held = motion: the drive is known at { $known } of { $count } positions; the others are not assessed
spring_balancing-spring-buckles = springs/{ $number }: { $slenderness } times as long as wide; it buckles unless it is guided

# Progress

spring_balancing-measuring-linkage = measuring the linkage
spring_balancing-finding-springs = finding springs
