## Formats

outlines-binary-dxf = The body is a binary DXF file; save it as text (ASCII) DXF.
outlines-dwg = The body is a DWG file; save it as text (ASCII) DXF.
outlines-compressed = The body is compressed; send the drawing itself.
outlines-coordinates-out-of-range = its coordinates go beyond { $limit }, or are no numbers

## XML and SVG

outlines-transform-unreadable = its transform cannot be read
outlines-transform-number-count = its transform has { $count } numbers in { $function }(...)
outlines-path-too-long = A path has more than { $limit } pieces.
outlines-unknown-path-command = it has no command “{ $command }”, at character { $position }
outlines-path-command-missing = a command is missing at character { $position }
outlines-path-number-missing = a number is missing at character { $position }
outlines-number-too-large = the number { $number } is too large
outlines-element-is-text = it is text; turn it into paths
outlines-element-is-picture = it is a picture
outlines-element-is-no-shape = it is no shape
outlines-too-many-svg-elements = The drawing has more than { $limit } elements, counting every use.
outlines-groups-nested-too-deep = The drawing nests groups or uses more than { $limit } deep.
outlines-use-of-missing-element = it uses something that is not in the drawing
outlines-too-many-pieces = The drawing has more than { $limit } lines and curves.
outlines-root-not-svg = The drawing is XML, but its root element is not <svg>.
outlines-view-box-unreadable = the numbers of its view box cannot be read
outlines-page-view-box-unreadable = The numbers of its viewBox cannot be read.
outlines-page-view-box-invalid = The viewBox of the drawing is not four numbers with a width and a height.
outlines-view-box-invalid = its view box is not four numbers with a width and a height
outlines-view-box-without-size = it has a view box, and a width or height that depends on the page
outlines-length-unreadable = its { $attribute } is no length, or one that depends on the page
outlines-path-data-wrong = its path data is wrong: { $reason }
outlines-points-unreadable = the numbers of its points cannot be read
outlines-points-not-pairs = its points are not pairs of numbers, two at least
outlines-too-many-elements = The drawing has more than { $limit } elements.
outlines-elements-nested-too-deep = The drawing has more than { $limit } elements within one another.
outlines-too-many-attributes = An element of the drawing has more than { $limit } attributes.
outlines-xml-entities = The drawing declares XML entities, which are not expanded here; save it without them.
outlines-malformed-xml = The drawing is not well-formed XML: { $reason }.
outlines-unknown-encoding = The drawing has an encoding that is not known here; save it as UTF-8.

## DXF

outlines-too-many-entities = The drawing has more than { $limit } entities, counting each insertion of a block.
outlines-element-is-dxf-text = it is text
outlines-entity-without-outline = entities of its type give no outline
outlines-entity-incomplete = it lacks what an entity of its type has
outlines-blocks-nested-too-deep = The drawing nests blocks more than { $limit } deep.
outlines-block-inserted-too-often = A block is inserted { $rows } × { $columns } times, more than { $limit }.
outlines-block-missing = it inserts a block that is not in the drawing
outlines-dxf-with-nul = The drawing contains NUL characters, which text DXF never does.
outlines-dxf-without-eof = The drawing does not end with EOF; it may be truncated.
outlines-dxf-unreadable = The drawing cannot be read as DXF ({ $error }).
outlines-number-unreadable = A number of the drawing cannot be read.
outlines-number-unreadable-near-line = A number of the drawing cannot be read, near line { $line }.
outlines-radius-unsuitable = its radius is not positive, or too large
outlines-length-zero = it has no length
outlines-several-parts = it has several parts
outlines-too-many-fit-points = it passes through more than { $limit } points
outlines-coordinates-unsuitable = its coordinates are too large, or no numbers
outlines-not-parallel-to-xy = it does not lie in a plane parallel to xy
outlines-blocks-in-blocks = The drawing has blocks more than { $limit } deep in one another.
outlines-spline-knots-or-degree = it has a number of knots, or a degree, that no spline has
outlines-spline-knots-not-ascending = its knots do not ascend, or its weights are not positive
outlines-spline-knots-span-nothing = its knots span nothing
outlines-bend-too-sharp = it bends too sharply to be followed

## Outlines

outlines-element-unreadable = it cannot be read
outlines-branching-ends = more than two open elements meet at one point there
outlines-open-ends = it is open: its ends are { $gap } apart
outlines-open-chain =
    { $count ->
        [one] it is open: it is joined to { $count } other, and their ends are { $gap } apart
       *[other] it is open: it is joined to { $count } others, and their ends are { $gap } apart
    }
outlines-foreign-format = The body is neither SVG nor the text form of DXF.
outlines-too-many-outlines = The drawing has { $count } closed outlines, more than { $limit }.
outlines-too-many-vertices = The outlines have more than { $limit } vertices together at a tolerance of { $tolerance }; give a larger one.
outlines-no-area = it encloses no area
outlines-too-many-corners = its polygon has { $count } vertices, more than { $limit }; give a larger tolerance
outlines-meets-itself = it meets itself ({ $place })
outlines-nothing-drawn = The drawing has no closed outline: it draws nothing.
outlines-none-closed =
    { $count ->
        [one] The drawing has no closed outline; { $count } element is not one, `errors` says why.
       *[other] The drawing has no closed outline; { $count } elements are not one, `errors` says why.
    }
