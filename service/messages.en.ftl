# Titles of errors

service-title-malformed-request = Malformed request
service-title-request-timeout = Request timeout
service-title-head-too-large = Head too large
service-title-no-drawing = No drawing
service-title-no-motion = No motion
service-title-no-forces = No forces
service-title-no-simulation = No simulation
service-title-unauthorized = Unauthorized
service-title-rate-limited = Rate limited
service-title-foreign-host = Foreign host
service-title-unsupported-media-type = Unsupported media type
service-title-incomplete-body = Incomplete body
service-title-body-too-large = Body too large
service-title-invalid-request = Invalid request
service-title-idempotency-key-reused = Idempotency key reused
service-title-malformed-json = Malformed JSON
service-title-malformed-drawing = Malformed drawing
service-title-invalid-drawing = Invalid drawing
service-title-store-unavailable = Store unavailable
service-title-queue-full = Queue full
service-title-busy = Busy
service-title-gone = Gone
service-title-not-found = Not found
service-title-method-not-allowed = Method not allowed
service-title-http-error = HTTP error
service-title-internal-error = Internal error
service-title-no-result = No result
service-title-too-many-listeners = Too many listeners
service-title-not-ready = Not ready
service-title-part-of-batch = Part of a batch
service-title-no-cad = No CAD
service-title-no-parts = No parts
service-title-worker-died = Worker died
service-title-timeout = Timeout
service-title-out-of-memory = Out of memory
service-title-invalid-problem = Invalid problem
service-title-invalid-mechanism = Invalid mechanism

# Requests as a whole

service-many-fields-invalid = More than { $count } fields of the request are invalid; the first { $count } are listed.
service-other-fields-invalid =
    { $count ->
        [one] { $count } other field is invalid.
       *[other] { $count } other fields are invalid.
    }
service-store-unavailable =
    The job store does not answer. Send the request again later; with an `Idempotency-Key` this creates at most one job.
service-queue-full = Your queue has reached its maximum number of jobs. Send the request again later.
service-client-gone = The client has disconnected.
service-kernels-compiling =
    The kernels for analyses are being compiled, once after the installation. `/readyz` reports the progress.
service-path-unknown = No such resource; check the path.
service-request-not-served = The request cannot be served.
service-request-failed = The request failed because of a defect of the service; its log has the details.
service-method-not-allowed = This path does not allow { $method }; it allows { $methods }.
service-unknown-method-not-allowed = This path does not allow this method; it allows { $methods }.
service-key-invalid = The API key is not valid.
service-key-missing = Send an API key: `Authorization: Bearer mechsynth_...`.
service-rate-limit-reached = This key has reached its limit of { $requests } requests in { $seconds } seconds.
service-host-foreign =
    Without API keys the service accepts only requests from this machine, addressed to a local host name. `mechsynth
    keys create NAME` makes a key.
service-body-compressed = The body must not be compressed.
service-body-incomplete = The connection was closed before the end of the body.
service-body-not-json = The body must be application/json.
service-body-too-large = The body must have at most { $count } bytes.
service-body-malformed = The body is not valid JSON: { $reason }.
service-key-twice = This key occurs twice; give it once.
service-too-many-values-here = Up to here the body has more than { $count } values; the limit is { $count }.
service-too-many-values = The body has more than { $count } values.
service-nested-too-deeply = This is nested more than { $count } levels deep.
service-idempotency-key-twice = Send only one `Idempotency-Key`.
service-idempotency-key-used = A different request has used this `Idempotency-Key`. Use a new key for a new request.
service-cursor-unknown = Expected a `next_cursor` of this service.
service-job-unknown = No job has this id.
service-too-many-listeners = Too many of your clients are listening; try again.

# Fields of requests

service-fault-at-place = { $path }: { $reason }
service-input-invalid = This value is not permitted here.
service-wrapper-missing = The request needs the field `{ $field }` around this object: { $example }.
service-field-required-as = This field is required, for example { $example }.
service-list-expected-as = Expected a list, for example { $example }.
service-object-expected-as = Expected an object, for example { $example }.
service-input-resembles = Did you mean { $near }? Expected { $names } or { $last }.
service-input-or-list = Expected { $names }, or a list, for example { $example }.
service-input-or-list-resembles = Did you mean { $near }? Expected { $names }, or a list, for example { $example }.
service-discriminator-resembles = The field { $field } must be one of: { $names }. Did you mean { $near }?
service-unknown-field-resembles-one-of =
    Unknown field; did you mean `{ $field }`? The fields are { $fields } and { $last }.
service-kind-missing = This field is required; it must be one of: { $names }.
service-kind-resembles = Unknown; did you mean { $near }? The permitted names are: { $names }.
service-kind-unsupported =
    The service does not support this; see { $page }. The permitted names are: { $names }.
service-unknown-field = Unknown field; check its name.
service-field-required = This field is required.
service-list-expected = Expected a list.
service-object-expected = Expected an object.
service-string-expected = Expected a string.
service-integer-expected = Expected an integer.
service-number-expected = Expected a number.
service-input-not-finite = Expected a finite number.
service-boolean-expected = Expected true or false.
service-input-greater-than = The value must be greater than { $limit }.
service-input-greater-equal = The value must be at least { $limit }.
service-input-less-than = The value must be less than { $limit }.
service-input-less-equal = The value must be at most { $limit }.
service-kind-unknown = Unknown; the permitted names are: { $names }.
service-output-unknown = The field `type` must be one of: { $names }.
service-unknown-field-resembles = Unknown field; did you mean `{ $field }`?
service-unknown-field-besides-one = Unknown field; the only field is { $field }.
service-unknown-field-besides = Unknown field; the fields are { $fields } and { $last }.
service-string-too-short =
    { $count ->
        [one] The string must have at least { $count } character.
       *[other] The string must have at least { $count } characters.
    }
service-string-too-long =
    { $count ->
        [one] The string must have at most { $count } character.
       *[other] The string must have at most { $count } characters.
    }
service-string-mismatch = The string must match the pattern '{ $pattern }'.
service-discriminator-missing = The field { $field } is required.
service-discriminator-unknown = The field { $field } must be one of: { $names }.
service-object-too-long =
    { $most ->
        [one] The object must have at most { $most } member.
       *[other] The object must have at most { $most } members.
    }
service-list-too-long =
    { $most ->
        [one] The list must have at most { $most } item, not { $count }.
       *[other] The list must have at most { $most } items, not { $count }.
    }
service-object-too-short =
    { $least ->
        [one] The object must have at least { $least } member, not { $count }.
       *[other] The object must have at least { $least } members, not { $count }.
    }
service-list-too-short =
    { $least ->
        [one] The list must have at least { $least } item, not { $count }.
       *[other] The list must have at least { $least } items, not { $count }.
    }
service-input-is = Expected { $name }.
service-input-one-of = Expected { $names } or { $last }.
service-label-unprintable = the label must not contain NUL or lone surrogates

# Analyses, drawings and files

service-file-unavailable = This type of mechanism has no .{ $form } file.
service-design-too-large-to-draw = The size of this design is beyond the range for drawings.
service-design-too-large-to-analyse = The size of this design is beyond the range for analyses.
service-forces-for-linkages-only = Joint forces are available for linkages only.
service-problem-without-dynamics = The problem has no `dynamics`; post your own block.
service-design-unknown = Design { $number } does not exist; this job has designs 0 to { $last }.
service-job-without-designs = This job has no designs.
service-computation-impossible = The computation failed for these numbers; check all sizes, angles and counts.
service-simulation-unavailable = This type of mechanism has no simulations; they exist for linkages and gear trains.
service-pmks-opens-linkages-only = PMKS+ opens linkages only.
service-analysis-exceeds-time = The analysis exceeded its time limit of { $seconds } s; check all sizes and counts.
service-analysis-exceeds-memory = The analysis exceeded its memory limit; check all sizes and counts.
service-busy-with-analyses = The service is busy with other analyses. Send the request again.
service-drawing-exceeds-time = The drawing exceeded its time limit of { $seconds } s.
service-drawing-exceeds-memory = The drawing exceeded its memory limit.
service-busy-with-drawings = The service is busy with other drawings. Send the request again.
service-file-type-foreign = The body must have one of these types: { $types }.
service-busy-with-files = The service is busy with other files. Send the request again.
service-pixels-without-picture = Only a PNG picture has pixels; omit `pixel_size`.
service-solids-unavailable =
    Solids need the extra `cad`, which the service does not have; `process=laser` gives outlines without it.
service-busy-with-parts = The service is busy with other parts. Send the request again.
service-parts-exceed-limits = Making the parts exceeded the limit of { $seconds } seconds or the memory limit of a job.

# Jobs

service-filter-kind-unknown = unknown kind; the kinds are { $kinds }
service-problem-kind-unknown = There is no such kind of problem; the kinds are { $kinds }.
service-documents-not-ready = The documents of the API are still being written; try again soon.
service-job-part-of-batch = The job belongs to a batch; remove /v1/batches/{ $batch }.
service-job-ended-without-result = The job is { $status } and has no result.
service-job-without-result-yet = The job has no result yet.
service-store-file-lost = The file of the database has been removed or replaced; stop the service and restore the file.
service-store-full = The disk of the database is full.
service-store-read-only = The database can only be read.
service-store-silent = The job store does not answer.
service-kernels-missing = No worker has started yet: numerical kernels are being compiled, which after an installation takes about a minute.
service-no-worker-started = No worker has finished starting yet.
service-computation-failed = The computation failed because of a defect of the service; its log has the details.
service-worker-died = The job was given up because its worker process died in every attempt.
service-time-limit-exceeded = The computation was stopped at the time limit of { $seconds } s.
service-memory-limit-exceeded = The computation exceeded the memory limit of { $size } MiB.
service-sample-invalid = With these values the problem is invalid: { $path }: { $reason }
service-compiling = compiling numerical code that this job is the first to need

# Batches

service-number-not-finite = This must be a finite number.
service-batch-kind-varied = All problems of a batch have the same kind; `kind` cannot be varied.
service-field-varied-twice = This field is already varied, as a whole or in part.
service-hypercube-needs-samples = A Latin hypercube needs `samples`, the number of problems.
service-sampling-without-samples = The values determine the number of problems of a { $sampling }; omit `samples`.
service-sampling-without-seed = A { $sampling } has no random draws; omit `seed`.
service-hypercube-without-count = A Latin hypercube has one value for each of its `samples`; omit `count`.
service-count-missing = Give `count`, the number of values.
service-zip-counts-differ = In a zip all fields need the same number of values; the first field has { $count }.
service-batch-too-large = These values give { $count } problems; a batch can have at most { $most }.
service-batch-values-too-long = The values of { $count } problems exceed { $size } MiB; give fewer or shorter values.
service-metric-unknown = Unknown metric; this kind has { $metrics }.
service-metric-twice = This metric is given twice; give it once.
service-value-is = The value is { $value }.
service-values-or-range = give either values, or from and to
service-batch-progress = { $done } of { $total }
service-batch-unknown = No batch has this id.
service-batch-metric-unknown = Unknown metric; this batch has { $metrics }.
service-batch-without-metrics = Unknown metric; this batch has none.
service-metric-weighed-twice = { $metric } is named twice; minimize or maximize it once.
service-metric-missing = Name a metric to minimize (`least`) or to maximize (`greatest`).
service-index-expected = Expected the index of a list element, counted from 0; got { $step }.
service-element-missing = Element { $index } does not exist; the length of the list is { $length }.
service-place-without-members = The value before { $step } is neither an object nor a list.
service-about-malformed-request = The data received is not an HTTP request. Use an HTTP client library.
service-about-incomplete-body = The connection ended before the whole body had arrived. Send the request again.
service-about-malformed-json = The body is not valid JSON, or nests too deeply. `errors` names the place.
service-about-malformed-drawing = The file cannot be read as a drawing, a table or a picture.
service-about-http-error = The request violates HTTP. The status says how.
service-about-unauthorized = The service has API keys, and the request has none or an invalid one. Send `Authorization: Bearer` with a key.
service-about-foreign-host = The service has no API keys, so it answers only requests to its own machine. The operator can create a key.
service-about-not-found = Nothing is at this address for this key. Ids of other tenants are answered in the same way.
service-about-method-not-allowed = The address exists, but not for this method. The header `Allow` lists the methods.
service-about-request-timeout = The request did not arrive completely in time. Send it again.
service-about-idempotency-key-reused = The `Idempotency-Key` belongs to an earlier request with another body. Use a new key for a new request.
service-about-part-of-batch = The job is one of the problems of a batch, which can only be removed as a whole.
service-about-no-result = The job has no result: it is unfinished, has failed, or was cancelled. Its state is in the job.
service-about-no-drawing = The design cannot be drawn within the limits of the service.
service-about-no-motion = The design has no motion that could be computed.
service-about-no-forces = The problem has no `dynamics`, and the request gives none. Post your own masses and loads.
service-about-no-simulation = The design cannot be written for this simulation program.
service-about-no-parts = The design cannot be made as parts with these options. `detail` says why.
service-about-body-too-large = The body is larger than the service accepts. The operator sets the limit by `MECHSYNTH_MAX_BODY_BYTES`.
service-about-unsupported-media-type = The operation does not accept bodies of this `Content-Type`.
service-about-invalid-request = A parameter, a header or a field is not valid. `errors` names each place and what is expected there.
service-about-invalid-problem = The problem is not valid or contradicts itself. `errors` names each place and what is expected there.
service-about-invalid-mechanism = The mechanism or its motion is not valid, or exceeds the limits of an analysis. `errors` names each place.
service-about-invalid-drawing = The file can be read but not used. `errors` names its elements.
service-about-rate-limited = The key has sent too many requests. Wait for the seconds in `Retry-After`.
service-about-head-too-large = The address and the headers of the request are too large together.
service-about-gone = The client has disconnected. Only the log and the metrics have this error.
service-about-internal-error = The service has a defect. The log of the operator has the details under the `X-Request-ID` of the answer.
service-about-worker-died = The process that computed the job has died too often, so the job was given up.
service-about-no-cad = The service cannot make solids: it runs without the extra `cad`.
service-about-busy = The service is busy with other requests, or still prepares itself after the start. Try again after the seconds in `Retry-After`.
service-about-queue-full = The tenant has as many waiting jobs as the service accepts. Try again when some have ended.
service-about-too-many-listeners = Too many clients of the tenant follow jobs at the same time. Close some of the streams.
service-about-store-unavailable = The database does not answer. Stored jobs are safe. Try again after the seconds in `Retry-After`.
service-about-not-ready = The service cannot accept or compute jobs at present. `detail` says what is missing.
service-about-timeout = The job took longer than the service allows. Ask for less, or ask the operator for a higher limit.
service-about-out-of-memory = The job needed more memory than the service allows. Ask for less, or ask the operator for a higher limit.
