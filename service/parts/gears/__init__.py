"""Trains of gears as parts: true teeth on keyed shafts between two plates.

Glossary:

wheel    a gear at its place: its teeth, its shaft, its level and its face;
level    a height in which wheels lie, counted from below; the lower plate is level 0, the upper one above them all;
reach    the lowest and the highest level that a shaft passes through, plates among them;
web      the disc that holds a ring on its shaft, in a level of its own;
play     by how much a tooth is made thinner so that teeth do not bind;
cluster  gears of a shaft that slide together on a feather key, in a range of levels.

:mod:`teeth` and :mod:`keys` are what wheels are cut to, :mod:`stand` finds where the shafts of a train stand so that
nothing is in the way, :mod:`housing` makes plates, posts and shafts with what is on them, and :mod:`motion` is how they
turn. The makers are :mod:`ordinary` and those beside it.
"""
