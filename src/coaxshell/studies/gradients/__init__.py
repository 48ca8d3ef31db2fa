"""A number read from a run and what every variable changes of it."""
