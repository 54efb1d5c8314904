## Pictures

imports-contours-too-long = The contours of the picture have more than { $limit } points, like those of a photograph. Send a drawing in two colours.
imports-png-unreadable = The picture cannot be read as PNG ({ $error }).
imports-too-many-pixels = The picture has { $width } × { $height } pixels, more than { $limit }.
imports-contrast-too-low = The picture has too little contrast; send dark lines on a light background or the reverse.

## Tables

imports-table-empty = The table has no rows.
imports-table-columns = Line { $line } of the table does not have two columns of numbers.
imports-table-too-long = The table has more than { $points } points, or more than { $curves } curves.
imports-table-without-points = The table has a header but no points.
imports-foreign-format = The body is neither SVG, DXF as text, PNG nor a table of points.
imports-table-single-column = The table has one column; it needs two, x and y.
imports-table-cell-not-number = Line { $line } of the table has a cell that is not a number.
imports-table-number-too-large = Line { $line } of the table has a number beyond { $limit }.

## Limits of reading

imports-reading-too-long = The file takes longer than { $seconds } seconds to read; send a smaller or simpler one.
imports-reading-too-large = The file takes more memory to read than a file has here; send a smaller or simpler one.

## Curves

imports-length-zero = its length is zero
imports-curve-too-long = A curve has more than { $limit } points at a tolerance of { $tolerance }; give a larger one.
imports-no-area = it encloses no area
imports-format-or-table-type = The body is neither SVG, DXF text nor PNG; a table is sent as text/csv.
imports-shorter-than-gap = it is not longer than the gap for joining ends
imports-few-pixels = it encloses only a few pixels
imports-coordinates-out-of-range = its coordinates exceed { $limit } or are not numbers
imports-too-many-points = The curves take more than { $limit } points together; give a larger tolerance.
imports-no-curve = The file has no curve.
imports-nothing-drawn = The file has no curve: it draws nothing.
imports-smaller-than-listed = it is smaller than the { $count } curves of an answer
