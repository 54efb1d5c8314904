"""Manufacture in requests and answers: grids, tolerances, yield."""
