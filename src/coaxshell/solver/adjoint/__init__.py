"""How a number read from a run changes with all that it was made from: one march backwards, whatever the number of variables."""
