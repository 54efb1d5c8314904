"""Batches: many problems, given as one problem whose fields are varied.

A *batch* is the client's request, a *sample* is one of its problems, and the *plan* defines the samples. The samples
are split into *shares*: ranges that are rows of the job table and are scheduled like jobs. A *slice* is the part of a
share that a worker solves without interruption. Its samples are stored together.
"""
