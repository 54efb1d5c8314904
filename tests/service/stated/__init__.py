"""For every field of every kind: a problem, and a value of the field with which its answer is another one."""
