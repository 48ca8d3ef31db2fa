"""The checks, one subject a file; importing a file registers its checks."""

ORDER = (
    "reference",
    "single_values",
    "paper_limits",
    "independent",
    "axial_wavenumbers",
    "axial_limits",
    "spherical_reference",
    "independent_stations",
    "stations",
    "engines",
    "energy",
    "time_step",
    "orders",
    "transparency",
    "rigid",
    "form_function",
    "translation",
    "statics",
    "rings",
    "causality",
    "disc_limit",
    "published",
    "published_frequencies",
)
"""Files in the order of the report."""
