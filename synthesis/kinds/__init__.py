"""The kinds of problems, a folder each: statement, answer, solver, verification and the algorithms of its own."""
