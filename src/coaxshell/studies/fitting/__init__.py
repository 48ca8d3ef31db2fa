"""Properties of a system identified from measured histories."""
