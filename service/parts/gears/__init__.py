"""Trains of gears as parts: true teeth on keyed shafts between two plates.

Glossary:

wheel    a gear at its place: its teeth, its shaft, its level and its face;
level    a height range of wheels, counted from below; the lower plate is level 0, the upper one above them all;
reach    the lowest and the highest level that a shaft passes, including plates;
web      the disc that holds a ring on its shaft, in a level of its own;
play     reduction of tooth thickness that prevents binding;
cluster  gears of a shaft that slide together on a feather key, in a range of levels.

:mod:`service.parts.gears.teeth` and :mod:`service.parts.assembly.keys` define the outlines of teeth and bores.
:mod:`service.parts.gears.stand` arranges the shafts of a train without interference,
:mod:`service.parts.gears.housing` makes plates, posts and shafts with the parts on them, and
:mod:`service.parts.gears.motion` describes the rotations. Each type of train has a maker, for example
:mod:`service.parts.gears.ordinary`.
"""
