"""Many problems at once, stated as one whose fields are varied.

Words: a *batch* is what a client has stated; a *sample* is one problem of it; its *plan* says which those are. The plan
is dealt into *shares*, ranges of samples that are rows among the jobs and taken by turns like these; what a worker
solves of a share in one go is a *slice*, whose samples come into the store together.
"""
