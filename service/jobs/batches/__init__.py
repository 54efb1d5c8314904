"""Batches: many problems, given as one problem whose fields are varied.

Words: a *batch* is the client's request; a *sample* is one of its problems; the *plan* defines the samples. The plan is
split into *shares*, ranges of samples that are rows of the job table and are scheduled like jobs. The samples that a
worker solves of a share in one go are a *slice*; they are stored together.
"""
