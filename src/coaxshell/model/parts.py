"""What a system consists of, and what follows from its parts alone; nothing here asks whether they fit together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any

from pydantic import BeforeValidator

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing, PointAbsorber
from coaxshell.model.base import UNSTATED, Described, shown, stated
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import LAW, Feedback
from coaxshell.model.fluids import AnyFluid, Fluid, Vacuum
from coaxshell.model.paths import within
from coaxshell.model.places import shell_number, shell_words
from coaxshell.model.sea import Sea
from coaxshell.model.shells import AnyShell, RigidShell, Shell
from coaxshell.model.sources import Source, as_source, source_distance
from coaxshell.numerics.scalars import plain


def _several(value: Any, build: Any) -> Any:
    """Build each item of a sequence, naming the index of the one that fails."""
    built = []
    for index, item in enumerate(value):
        try:
            built.append(build(item))
        except InputError as error:
            raise within(f"[{index}]", error) from None
    return tuple(built)


def _as_sources(value: Any) -> Any:
    return _several(value, as_source) if isinstance(value, list | tuple) else as_source(value)


def _as_absorber(value: Any) -> Absorber | AbsorberRing | PointAbsorber:
    if isinstance(value, Absorber | AbsorberRing | PointAbsorber):
        return value
    if isinstance(value, Mapping) and "z" in value:
        return PointAbsorber.model_validate(dict(value))
    if isinstance(value, Mapping) and not {"count", "offset"}.isdisjoint(value):
        if "angle" in value:
            raise InputError(
                "angle",
                "belongs to a single absorber, but count or offset describe a ring",
                "for a ring give count and offset, the angle of its first absorber; for one absorber leave both out",
            )
        return AbsorberRing.model_validate(dict(value))
    if isinstance(value, Mapping):
        return Absorber.model_validate(dict(value))
    raise InputError("", f"{shown(value)} is not an absorber", "give an Absorber, a list of them, or an AbsorberRing")


def _as_absorbers(value: Any) -> Any:
    if value is None or value == "none":
        return ()
    if not isinstance(value, list | tuple):
        single = _as_absorber(value)
        return single if isinstance(single, AbsorberRing) else (single,)
    # Several rings, for instance one in each gap, are written out.
    items: tuple[Absorber | AbsorberRing | PointAbsorber, ...] = _several(value, _as_absorber)
    return tuple(one for item in items for one in (item.absorbers if isinstance(item, AbsorberRing) else (item,)))


def _as_control(value: Any) -> Any:
    if value is None or (isinstance(value, str) and value == "none"):
        return None
    if isinstance(value, PDControl | Feedback):
        return value
    if isinstance(value, list | tuple):
        laws = _several(value, _as_law)
        return (laws[0] if len(laws) == 1 else laws) if laws else None
    return _as_law(value)


def _as_law(value: Any) -> PDControl | Feedback:
    if isinstance(value, PDControl | Feedback):
        return value
    if isinstance(value, Mapping):
        other = not LAW.isdisjoint(value) and {"proportional", "derivative"}.isdisjoint(value)
        return (Feedback if other else PDControl).model_validate(dict(value))
    remedy = "give a PDControl, a Feedback, a table of the entries of one, or a list of these, each for other shells"
    raise InputError("", f"{shown(value)} is not a control law", remedy)


def _unless_none(value: Any) -> Any:
    return None if value == "none" else value


class SystemParts(Described):
    """Shells, fluids, sources, absorbers, control and the sea; see :class:`coaxshell.System`, which checks, changes and writes them."""

    name: str = ""
    """What the system is called."""
    shells: tuple[AnyShell, ...]
    """The shells, innermost first."""
    fluids: tuple[AnyFluid, ...]
    """The fluids, innermost first: one more than shells."""
    source: Annotated[Source | tuple[Source, ...], BeforeValidator(_as_sources)]
    """The source, or several."""
    absorbers: Annotated[AbsorberRing | tuple[Absorber | PointAbsorber, ...], BeforeValidator(_as_absorbers)] = ()
    """A ring of equal absorbers, or single ones; point absorbers in three dimensions."""
    control: Annotated[PDControl | Feedback | tuple[PDControl | Feedback, ...] | None, BeforeValidator(_as_control)] = None
    """The controller, if there is one, or several, each for shells of its own."""
    sea: Annotated[Sea | None, BeforeValidator(_unless_none)] = None
    """The sea around it, if its surface, its bottom or its pressure counts."""

    def __init__(
        self,
        *,
        shells: Sequence[Shell | RigidShell | Mapping[str, Any]] = UNSTATED,
        fluids: Sequence[Fluid | Vacuum | str | Mapping[str, Any]] = UNSTATED,
        source: Source | Sequence[Source] | Mapping[str, Any] = UNSTATED,
        absorbers: AbsorberRing | Absorber | PointAbsorber | Sequence[Absorber | PointAbsorber] | Mapping[str, Any] | None = (),
        control: PDControl | Feedback | Sequence[PDControl | Feedback] | Mapping[str, Any] | None = None,
        sea: Sea | Mapping[str, Any] | None = None,
        name: str = "",
        **unknown: Any,
    ) -> None:
        given: dict[str, Any] = {"name": name, "shells": shells, "fluids": fluids, "source": source}
        given |= {"absorbers": absorbers, "control": control, "sea": sea}
        super().__init__(**stated(given), **unknown)

    @property
    def sources(self) -> tuple[Source, ...]:
        """The sources, always as a tuple."""
        return self.source if isinstance(self.source, tuple) else (self.source,)

    @property
    def absorber_list(self) -> tuple[Absorber, ...]:
        """The single absorbers of two dimensions, those of a ring written out."""
        if isinstance(self.absorbers, AbsorberRing):
            return self.absorbers.absorbers
        return tuple(one for one in self.absorbers if isinstance(one, Absorber))

    @property
    def point_absorbers(self) -> tuple[PointAbsorber, ...]:
        """The absorbers of three dimensions."""
        return () if isinstance(self.absorbers, AbsorberRing) else tuple(one for one in self.absorbers if isinstance(one, PointAbsorber))

    @property
    def reference_radius(self) -> float:
        """Mid-surface radius a of the outermost shell (m), the unit of length of the dimensionless problem."""
        return self.shells[-1].radius

    @property
    def head_radius(self) -> float:
        """Distance of the head point from the axis (m): the radius of the surface that the exterior fluid wets."""
        return self.shells[-1].wetted_radii[1]

    @property
    def transit_time(self) -> float:
        """Seconds in an acoustic transit a/c_e of the outermost radius in the fluid outside, the unit of time of a run."""
        return self.reference_radius / self.exterior.sound_speed

    @property
    def exterior(self) -> Fluid:
        """The fluid outside, whose sound speed and density scale the problem."""
        fluid = self.fluids[-1]
        assert isinstance(fluid, Fluid)  # the whole was checked on construction
        return fluid

    @property
    def source_distances(self) -> tuple[float | None, ...]:
        """Distance of each source from the axis (m); None for a plane wave. Stand-offs start at the head point."""
        return tuple(self.source_distance(source) for source in self.sources)

    def source_distance(self, source: Source) -> float | None:
        """Return the distance of a source from the axis (m); None for a plane wave."""
        return source_distance(source, self.head_radius)

    @property
    def controlled_shells(self) -> tuple[int, ...]:
        """Numbers of the shells under control, in order; empty without control."""
        return tuple(sorted(shell for law in laws_of(self) for shell in shells_under(self, law)))

    def shell_index(self, shell: int | str) -> int:
        """Return the number of a shell given as a number, a text of digits, "inner", "outer" or another name; InputError otherwise."""
        count = len(self.shells)
        number = shell_number(shell, count) if isinstance(shell, str) else plain(shell)
        if isinstance(number, int) and not isinstance(number, bool) and 0 <= number < count:
            return number
        numbers = "0" if count == 1 else f"0 to {count - 1}"
        words = " or ".join(repr(word) for word in shell_words(count))
        raise InputError("shell", f"{shell!r} is not a shell of this system", f"must be {numbers} (from the inside), {words}")

    def shell_indices(self, shells: Iterable[int | str] | int | str | None = None) -> list[int]:
        """Return the numbers of one shell or several, given as to :meth:`shell_index`; of all that are not rigid for None."""
        if shells is None:
            return [i for i, shell in enumerate(self.shells) if not isinstance(shell, RigidShell)]
        return [self.shell_index(shell) for shell in ([shells] if isinstance(shells, int | str) else shells)]


def laws_of(system: SystemParts) -> tuple[PDControl | Feedback, ...]:
    """Return the control laws of a system, always as a tuple."""
    control = system.control
    return control if isinstance(control, tuple) else () if control is None else (control,)


def shells_under(system: SystemParts, law: PDControl | Feedback) -> tuple[int, ...]:
    """Return the numbers of the shells that a control law is for, in order."""
    return tuple(range(len(system.shells))) if law.shells == "all" else tuple(sorted(system.shell_index(one) for one in law.shells))
