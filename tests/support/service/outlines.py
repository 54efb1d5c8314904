"""Code that several tests share: outlines."""

import math

SEGMENT = 200 * (math.pi / 3 - math.sqrt(3) / 2)
INNER = 'x="10" y="20" width="40" height="20" viewBox="-5 -5 10 10"'
UNIT = '<rect x="-5" y="-5" width="10" height="10"/>'
SHAPES = {
    # Each within the unit of a page 100 high, with its area and the middle of its bounds.
    '<rect x="10" y="10" width="30" height="20" rx="5"/>': (600 - (4 - math.pi) * 25, (25, 80)),
    '<rect x="10" y="10" width="30" height="20" rx="40" ry="2"/>': (600 - (4 - math.pi) * 30, (25, 80)),
    '<ellipse cx="50" cy="50" rx="20" ry="10"/>': (math.pi * 200, (50, 50)),
    '<polygon points="0,0 30,0 30,40"/>': (600, (15, 80)),
    '<polyline points="0 0 30 0 30 40 0 0"/>': (600, (15, 80)),
    '<path d="m10 10h20v20h-20z"/>': (400, (20, 80)),
    '<path d="M10,10 H30 V30 H10 Z" transform="translate(10) scale(2,1)"/>': (800, (50, 80)),
    '<path d="M10 10L30 10 30 30 10 30z" transform="rotate(45 20 20)"/>': (400, (20, 80)),
    '<path d="M10 10h20v20h-20z" transform="skewX(45)"/>': (400, (40, 80)),
    '<path d="M10 10h20v20h-20z" transform="matrix(0 1 -1 0 50 0)"/>': (400, (30, 80)),
    # The segment of a parabola is two thirds of its box.
    '<path d="M0 0Q30 60 60 0z"/>': (60 * 30 * 2 / 3, (30, 85)),
    # A cubic whose area is by Green's theorem 3/20 of three products of its sides, here 3/20 (2·1 + 2·1 - 0)·30².
    '<path d="M20 50C20 20 50 20 50 50z"/>': (0.6 * 900, (35, 50 + 22.5 / 2)),
    '<path d="M20 50c0-30 30-30 30 0s30 30 30 0z" fill="none"/>': None,
    # Half a disc, by an arc of either flag, and one whose radius does not reach.
    '<path d="M20 50a20 20 0 0 1 40 0z"/>': (0.5 * math.pi * 400, (40, 60)),
    '<path d="M20 50A20,20,0,1,0,60,50z"/>': (0.5 * math.pi * 400, (40, 40)),
    '<path d="M20 50a1 1 0 0140 0z"/>': (0.5 * math.pi * 400, (40, 60)),
    # Two circles of radius 20 through two points 20 apart: the segments of 60° and of 300°.
    '<path d="M40 50A20 20 0 0 1 60 50z"/>': (SEGMENT, (50, 50 + 10 - 5 * math.sqrt(3))),
    '<path d="M40 50A20 20 0 0 0 60 50z"/>': (SEGMENT, (50, 50 - 10 + 5 * math.sqrt(3))),
    '<path d="M40 50A20 20 0 1 1 60 50z"/>': (400 * math.pi - SEGMENT, (50, 50 + 10 + 5 * math.sqrt(3))),
    '<path d="M40 50A20 20 0 1 0 60 50z"/>': (400 * math.pi - SEGMENT, (50, 50 - 10 - 5 * math.sqrt(3))),
    # An ellipse of which a quarter is taken away.
    '<path d="M70 50A20 10 0 1 1 50 40L50 50z"/>': (math.pi * 200 * 0.75, (50, 50)),
    '<g transform="translate(5 5)"><g transform="scale(2)"><rect width="5" height="5"/></g></g>': (100, (10, 90)),
    '<defs><rect id="u" width="10" height="10"/></defs><use href="#u" x="5" y="5"/>': (100, (10, 90)),
    '<symbol id="u"><rect width="5" height="5"/></symbol><use xlink:href="#u" transform="scale(2)"/>': (100, (5, 95)),
    '<symbol id="u" viewBox="1 1 5 5"><rect x="1" y="1" width="5" height="5"/></symbol>'
    '<use href="#u" x="10" y="10" width="20" height="20"/>': (400, (20, 80)),
    # A drawing in the drawing, fitted into its page as it says: 10 by 10 into 40 by 20.
    f'<svg {INNER}>{UNIT}</svg>': (400, (30, 70)),
    f'<svg {INNER} preserveAspectRatio="xMinYMid meet">{UNIT}</svg>': (400, (20, 70)),
    f'<svg {INNER} preserveAspectRatio="xMaxYMax">{UNIT}</svg>': (400, (40, 70)),
    f'<svg {INNER} preserveAspectRatio="xMidYMax slice">{UNIT}</svg>': (1600, (30, 80)),
    f'<svg {INNER} preserveAspectRatio="none">{UNIT}</svg>': (800, (30, 70)),
    f'<svg x="10" y="20">{UNIT}</svg>': (100, (10, 80)),
}  # fmt: skip
