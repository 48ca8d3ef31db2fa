"""What data from outside may cost: the one table of bounds on texts, files and requests.

Outside data are quantities, names, scenario and study files, records, saved runs, links and bodies of the studio. Each is measured
against its bound before anything is parsed, allocated or computed. The documentation shows this table.
"""

from __future__ import annotations

from dataclasses import dataclass

from coaxshell.errors import InputError


@dataclass(frozen=True)
class Limit:
    """One bound.

    Attributes
    ----------
    value : int
        The largest that is accepted.
    unit : str
        What is counted: ``"characters"``, ``"bytes"``, ``"samples"``.
    what : str
        Whose size it bounds, in the user's words.
    """

    value: int
    unit: str
    what: str

    def check(self, size: int, where: str, remedy: str = "") -> None:
        """Refuse what is larger.

        Raises
        ------
        InputError
            With ``where``, the size found and the bound.
        """
        if size > self.value:
            raise InputError(where, f"{self.what} has {size:,} {self.unit}; at most {self.value:,} are read", remedy)


QUANTITY = Limit(100, "characters", "a quantity with its unit")
PATH = Limit(200, "characters", "a path of an entry")
EXPRESSION = Limit(300, "characters", "a metric, objective or constraint")
TOML_BYTES = Limit(32_000_000, "bytes", "a scenario or study file")
TOML_NESTING = Limit(24, "levels", "the nesting of a TOML text")
TOML_DOTS = Limit(12, "dots", "a key of a TOML text")
TOML_ENTRIES = Limit(50_000, "entries", "a TOML text")
TOML_VALUES = Limit(1_000_000, "values", "a TOML text")
TOML_LISTS = Limit(50_000, "lists and tables", "a TOML text")
RECORD_BYTES = Limit(200_000_000, "bytes", "a pressure record")
RECORD_SAMPLES = Limit(1_000_000, "samples", "a pressure record")
RECORD_COLUMNS = Limit(256, "columns", "a pressure record")
HISTORY_COLUMNS = Limit(12_000, "columns", "a file of histories")
SAVED_TEXT = Limit(32_000_000, "bytes", "a text in a saved run")
SAVED_STRUCTURE = Limit(250_000_000, "bytes", "what a saved run holds beside its arrays")
SAVED_ARRAYS = Limit(16_000_000_000, "bytes", "the arrays of a saved run")
SAVED_CHUNK = Limit(64_000_000, "bytes", "a chunk of a compressed array")
RING = Limit(10_000, "absorbers", "a ring")
STATIONS = Limit(200, "axial positions", "a list of stations")
STUDIO_BODY = Limit(1_000_000, "bytes", "a request to the studio")
STUDIO_PROJECT = Limit(8_000_000, "bytes", "a project of the studio")
STUDIO_DESIGNS = Limit(20, "designs", "a project of the studio")
STUDIO_UPLOAD = Limit(64_000_000, "bytes", "a run opened in the studio")
STUDIO_NESTING = Limit(24, "levels", "the nesting of a request to the studio")
STUDIO_SHELLS = Limit(6, "shells", "a system in the studio")
STUDIO_LAYERS = Limit(12, "layers", "a shell in the studio")
STUDIO_ABSORBERS = Limit(200, "absorbers", "a system in the studio")
STUDIO_SOURCES = Limit(8, "sources", "a system in the studio")
STUDIO_STATIONS = Limit(20, "stations", "a run in the studio")
STUDIO_SAMPLES = Limit(20_000, "samples", "a record in the studio")

TABLE: tuple[Limit, ...] = (
    QUANTITY,
    PATH,
    EXPRESSION,
    TOML_BYTES,
    TOML_NESTING,
    TOML_DOTS,
    TOML_ENTRIES,
    TOML_VALUES,
    TOML_LISTS,
    RECORD_BYTES,
    RECORD_SAMPLES,
    RECORD_COLUMNS,
    HISTORY_COLUMNS,
    SAVED_TEXT,
    SAVED_STRUCTURE,
    SAVED_ARRAYS,
    SAVED_CHUNK,
    RING,
    STATIONS,
    STUDIO_BODY,
    STUDIO_PROJECT,
    STUDIO_DESIGNS,
    STUDIO_UPLOAD,
    STUDIO_NESTING,
    STUDIO_SHELLS,
    STUDIO_LAYERS,
    STUDIO_ABSORBERS,
    STUDIO_SOURCES,
    STUDIO_STATIONS,
    STUDIO_SAMPLES,
)
"""All bounds, in the order in which the documentation lists them."""
