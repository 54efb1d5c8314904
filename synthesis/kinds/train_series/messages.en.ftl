# Contradictions.

train_series-size-needs-tolerance = ranking by size needs a tolerance for the ratio
train_series-hunting-teeth-not-preferable =
    a unit of a series has no trains of equal error to prefer from; choose any or require
train_series-shafts-not-parallel = all shafts of a series are parallel; those of a { $type } stage are not
# $types: names of the types, separated by commas
train_series-unknown-type = type must be given and be one of: { $types }

# Searches that are too large. $trains, $series, $limit: rounded numbers such as 5e+07.

train_series-ordinary-unit-too-large =
    about { $trains } trains exceed the limit of { $limit } per unit; narrow the tooth numbers, or make its stages
    separate units
train_series-planetary-unit-too-large =
    about { $trains } trains exceed the limit of { $limit } per unit; narrow the tooth numbers, or give an arrangement
    and its members
train_series-too-many-series =
    about { $series } series are too many for the search; narrow the tooth numbers, or give members

# Progress of the search.

train_series-listing-teeth = unit { $unit }: tooth numbers
# $series: a rounded number such as 1.23e+08
train_series-searching = { $series } series
train_series-verifying = verifying
train_series-verified = verified

# Summary. $product: the ratios of the units, such as 5 × 6.25; $searched: the series searched, and the number of
# equally exact ones if there are several.

train_series-best-exact = { $product } is exactly { $ratio }; { $searched }.
train_series-best-nearest = { $product } is { $reached } instead of { $ratio }, an error of { $error } %; { $searched }.
train_series-unit-without-trains = No such series exists: no train satisfies the constraints of unit { $unit }.
train_series-none-turns-same = No such series exists: none turns input and output in the same direction; { $searched }.
train_series-none-turns-opposite =
    No such series exists: none turns input and output in the opposite direction; { $searched }.
train_series-none-verified = No series passed the verification; { $searched }.
train_series-nearest-too-far =
    No such series exists: the nearest has the ratio { $ratio }, an error of { $error } %; { $searched }.
train_series-searched = { $count } series searched
train_series-ties = { $count } series have this error
