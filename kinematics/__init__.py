"""Analysis of given mechanisms: pure numerics on arrays, without optimizers, files, clocks or HTTP."""
