"""Search for the best system: variables, objectives and constraints, methods, the answer."""
