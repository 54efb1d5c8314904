"""All Watt II sixbars through nine pairs, by continuation."""
