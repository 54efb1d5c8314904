"""What a given mechanism does: pure numerics on arrays, without optimizers, files, clocks or HTTP."""
