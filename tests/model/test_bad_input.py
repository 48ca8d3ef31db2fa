"""Bad input: one line that names the field, the value found and what is allowed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import coaxshell.model as cx
from coaxshell.errors import InputError
from coaxshell.model import materials, presets

BARE = presets.load("bare")
HYBRID = presets.load("hybrid")
SINGLE = presets.load("iakovlev-filled")
GAINS = {"proportional": -1.0, "derivative": -1.0}
PZT = materials.PZT4
ALUMINIUM = materials.ALUMINIUM
STEP = cx.Step(pressure=1.0)


def elastic(**changes: Any) -> cx.Elastic:
    return cx.Elastic(**{"name": "x", "density": 1, "youngs_modulus": 1, "poisson_ratio": 0.3, **changes})


def ring(**changes: Any) -> cx.AbsorberRing:
    return cx.AbsorberRing(**{"count": 2, "mass": 1, "damping": 1, **changes})


def control(**changes: Any) -> cx.PDControl:
    return cx.PDControl(**{"proportional": -1, "derivative": -1, **changes})


def wall(*layers: cx.Layer, radius: float = 1.0) -> cx.Shell:
    return cx.Shell(radius=radius, layers=layers)


def toml(old: str, new: str) -> cx.System:
    text = presets.text("hybrid")
    assert old in text
    return cx.System.from_toml_string(text.replace(old, new, 1))


# what is done, and the pieces that the message must hold: the field, the value, the remedy
CASES: dict[str, tuple[Callable[[], Any], tuple[str, ...]]] = {
    # materials
    "negative density": (lambda: elastic(density=-1), ("density:", "-1.0 kg/m^3", "greater than 0")),
    "zero modulus": (lambda: elastic(youngs_modulus=0), ("youngs_modulus:", "0.0 Pa", "greater than 0")),
    "nan modulus": (lambda: elastic(youngs_modulus=float("nan")), ("youngs_modulus:", "nan", "not finite", "'70 GPa'")),
    "infinite density": (lambda: elastic(density=float("inf")), ("density:", "inf", "not finite")),
    "incompressible": (lambda: elastic(poisson_ratio=0.5), ("poisson_ratio:", "0.5", "greater than -1 and less than 0.5")),
    "boolean density": (lambda: elastic(density=True), ("density:", "True", "not a density", "kg/m^3")),
    "name not text": (lambda: elastic(name=3), ("name:", "3", "must be text")),
    "missing modulus": (
        lambda: cx.Elastic(name="x", density=1, poisson_ratio=0.3),  # type: ignore[call-arg]
        ("youngs_modulus:", "is missing", "Elastic needs it"),
    ),
    "misspelt entry": (lambda: elastic(yungs_modulus=1), ("yungs_modulus:", "not an entry of Elastic", "did you mean 'youngs_modulus'?")),
    "wrong unit": (lambda: elastic(youngs_modulus="70 kg"), ("youngs_modulus:", "'70 kg'", "not a stress or modulus", "'70 GPa'")),
    "unknown unit": (lambda: elastic(density="3 parsnips"), ("density:", "'3 parsnips'", "unknown unit 'parsnips'", "'7.8 g/cm^3'")),
    "unit alone": (lambda: elastic(density="GPa"), ("density:", "'GPa'", "not a density", "kg/m^3")),
    "unstable ceramic": (lambda: PZT.replace(c23=2e11), ("c23:", "200000000000.0 Pa", "unstable", "c23^2 < c22*c33")),
    "printed permittivity": (
        lambda: PZT.replace(permittivity_33=1.7e-9),
        ("permittivity_33:", "1.7e-09 F/m", "1.72878e-09 F/m", 'permittivity_reduction = "standard"'),
    ),
    "unknown reduction": (
        lambda: PZT.replace(permittivity_reduction="thin"),
        ("permittivity_reduction:", "'thin'", "'standard' or 'printed'"),
    ),
    "unknown material": (lambda: materials.get("aluminim"), ("'aluminim'", "not a known material", "did you mean 'aluminium'?")),
    # fluids
    "still fluid": (lambda: cx.Fluid(density=1000, sound_speed=0), ("sound_speed:", "0.0 m/s", "greater than 0")),
    "unknown fluid": (lambda: BARE.replace(fluids=["vacuum", "sea", "air"]), ("fluids[1]:", "'sea'", "not a known fluid", "'seawater'")),
    "too few fluids": (lambda: BARE.replace(fluids=["air"]), ("fluids:", "has 1", "2 shell(s)", "must be 3")),
    "vacuum outside": (lambda: BARE.replace(fluids=["air", "air", "vacuum"]), ("fluids[2]:", "'vacuum'", "must be a fluid")),
    "fluid of wrong type": (lambda: BARE.replace(fluids=[1, 2, 3]), ("fluids[0]:", "1 is not a fluid", "give a Fluid, VACUUM")),
    # layers and shells
    "negative thickness": (lambda: cx.Layer(ALUMINIUM, -0.003), ("thickness:", "-0.003 m", "greater than 0")),
    "misspelt thickness": (lambda: cx.Layer(ALUMINIUM, thicknes=1e-3), ("thicknes:", "is not an entry of Layer", "'thickness'")),
    "missing thickness": (lambda: cx.Layer(ALUMINIUM), ("thickness:", "is missing", "Layer needs it")),
    "ceramic without role": (lambda: cx.Layer(PZT, 0.003), ("role:", "missing", "'PZT-4'", "'self-sensing' or 'passive'")),
    "ceramic as core": (lambda: cx.Layer(PZT, 0.003, "core"), ("role:", "'core'", "'PZT-4'", "'self-sensing' or 'passive'")),
    "elastic sensor": (lambda: cx.Layer(ALUMINIUM, 0.003, "sensor"), ("role:", "'sensor'", "'aluminium'", "'core' or 'passive'")),
    "unknown role": (
        lambda: cx.Layer(ALUMINIUM, 1, "skin"),
        ("role:", "'skin'", "'core', 'sensor', 'charge-sensor', 'actuator', 'self-sensing' or 'passive'"),
    ),  # type: ignore[arg-type]
    "no layers": (lambda: wall(), ("layers:", "0 given", "at least 1")),
    "thick shell": (lambda: wall(cx.Layer(ALUMINIUM, 2)), ("layers:", "2 m", "must be less than the radius 1 m")),
    "two sensors": (
        lambda: BARE.with_overrides({"shells[0].layers[2].role": "sensor", "control": GAINS}),
        ("shells[0].layers[2].role:", "'sensor'", "layers[0]", "at most one sensor", 'transducers = "electrodes"'),
    ),
    "two actuators": (
        lambda: BARE.with_overrides({"shells[1].layers": [*BARE.shells[1].layers, cx.Layer(PZT, 0.001, "actuator")], "control": GAINS}),
        ("shells[1].layers[3].role:", "'actuator'", "layers[2]", "at most one actuator", 'transducers = "electrodes"'),
    ),
    "self-sensing in the paper's law": (
        lambda: BARE.with_overrides({"shells[1].layers[0].role": "self-sensing", "control": GAINS}),
        ("shells[1].layers[0].role:", "'self-sensing'", "grounded faces", 'transducers = "electrodes"'),
    ),
    "gains for other shells": (
        lambda: BARE.replace(control={**GAINS, "derivative": [1, 2, 3]}),
        ("control.derivative:", "3 for 2", "1 or 2"),
    ),
    "a gain that is none": (lambda: cx.PDControl(proportional=[1, "a"], derivative=0), ("proportional[1]:", "'a'", "not a plain number")),
    "no gains": (lambda: cx.PDControl(proportional=[], derivative=0), ("proportional:", "list is empty", "one for each shell")),
    "zero radius": (lambda: cx.RigidShell(radius=0), ("radius:", "0.0 m", "greater than 0")),
    "no shells": (lambda: BARE.replace(shells=[]), ("shells:", "empty", "at least 1")),
    "shells outside in": (
        lambda: BARE.replace(shells=BARE.shells[::-1]),
        ("shells[1].radius:", "0.494 m", "1.006 m", "from the inside out"),
    ),
    "overlapping shells": (lambda: BARE.with_overrides({"shells[0].radius": 0.99}), ("shells[1].radius:", "0.994 m", "0.996 m")),
    "shell of wrong type": (lambda: BARE.replace(shells=[3]), ("shells[0]:", "3 is not a shell", "Shell or a RigidShell")),
    # pulses and sources
    "no peak": (lambda: cx.PlaneShock(peak_pressure=0, decay_time=1), ("peak_pressure:", "0.0 Pa", "different from 0")),
    "negative decay": (lambda: cx.PlaneShock(peak_pressure=1, decay_time=-1), ("decay_time:", "-1.0 s", "greater than 0")),
    "negative delay": (lambda: cx.PlaneWave(pulse=STEP, delay=-1), ("delay:", "-1.0 s", "at least 0")),
    "angle too far": (lambda: cx.PlaneWave(pulse=STEP, angle=400), ("angle:", "400.0 deg", "at least -360 and at most 360")),
    "along the axis": (
        lambda: cx.PlaneWave(pulse=STEP, inclination=-90),
        ("inclination:", "-90.0 deg", "greater than -90 and less than 90"),
    ),
    "a time for z": (lambda: BARE.with_overrides({"source.z": "1 s"}), ("source.z:", "'1 s'", "not a length")),
    "z of a line": (lambda: cx.LineWave(distance=5, pulse=STEP, z=1), ("z:", "not an entry of LineWave")),  # type: ignore[call-arg]
    "inclined sphere": (
        lambda: BARE.with_overrides({"source.inclination": 30}),
        ("source.inclination:", "not an entry of SphericalShock"),
    ),
    "inside at any z": (lambda: BARE.with_overrides({"source.distance": 0.8, "source.z": 50.0}), ("source.distance:", "0.8 m", "1.006 m")),
    "acausal Gaussian": (
        lambda: cx.Gaussian(peak_pressure=1, width=1, centre=5),
        ("centre:", "5.0 s", "width 1.0 s", "at least 6 widths, 6.0 s"),
    ),
    "unknown pulse": (lambda: cx.PlaneWave(pulse={"type": "exponental"}), ("pulse.type:", "'exponental'", "'exponential'")),  # type: ignore[arg-type]
    "one sample": (lambda: cx.Sampled(time=(0.0,), pressure=(1.0,)), ("time:", "1 samples", "at least 2")),
    "times fall": (lambda: cx.Sampled(time=(0.0, 2.0, 1.0), pressure=(1.0, 1.0, 1.0)), ("time[2]:", "1.0 s", "2.0 s", "increasing")),
    "lengths differ": (lambda: cx.Sampled(time=(0.0, 1.0), pressure=(1.0,)), ("pressure:", "1 pressures", "2 times")),
    "hole in samples": (
        lambda: cx.Sampled(time=(0.0, 1.0), pressure=(1.0, float("nan"))),
        ("pressure[1]:", "nan", "not finite"),
    ),
    "no source": (lambda: BARE.replace(source=[]), ("source:", "empty", "at least 1")),
    "missing source": (lambda: cx.System(shells=BARE.shells, fluids=BARE.fluids), ("source:", "is missing", "System needs it")),
    "source inside": (lambda: BARE.with_overrides({"source.distance": 0.8}), ("source.distance:", "0.8 m", "outer radius 1.006 m")),
    "second source inside": (
        lambda: BARE.replace(source=[BARE.source, cx.LineWave(distance=1, pulse=STEP)]),
        ("source[1].distance:", "1.0 m", "1.006 m"),
    ),
    "charge in the wall": (
        lambda: BARE.replace(source=cx.UnderwaterExplosion(charge_mass=1, stand_off=0.001)),
        ("source.stand_off:", "0.001 m", "greater than 0.006 m"),
    ),
    "unknown explosive": (
        lambda: cx.UnderwaterExplosion(charge_mass=1, stand_off=1, explosive="TMT"),
        ("explosive:", "'TMT'", "did you mean 'TNT'?"),
    ),
    # absorbers
    "negative absorber mass": (lambda: ring(mass=-1), ("mass:", "-1.0 kg/m", "at least 0")),
    "undetermined absorber": (lambda: ring(mass=0, damping=0), ("mass:", "0.0 kg/m", "undetermined", "greater than 0")),
    "fractional count": (lambda: ring(count=2.5), ("count:", "2.5", "whole number")),
    "negative count": (lambda: ring(count=-1), ("count:", "-1", "greater than or equal to 0")),
    "boolean count": (lambda: ring(count=True), ("count:", "True", "whole number")),
    "absorber on one shell": (lambda: SINGLE.replace(absorbers=ring()), ("absorbers:", "links two shells", "has 1", "add a shell")),
    "ring without count": (
        lambda: BARE.replace(absorbers={"mass": 1, "offset": 7}),
        ("absorbers.count:", "is missing", "AbsorberRing needs it"),
    ),
    "ring with an angle": (
        lambda: BARE.replace(absorbers={"mass": 1, "count": 3, "angle": 7}),
        ("absorbers.angle:", "single absorber", "give count and offset"),
    ),
    "angle and offset": (
        lambda: BARE.replace(absorbers=[{"mass": 1, "angle": 7, "offset": 7}]),
        ("absorbers[0].angle:", "single absorber", "leave both out"),
    ),
    "absorber beyond": (lambda: BARE.replace(absorbers=ring(inner_shell=1)), ("absorbers.inner_shell:", "1", "at most 0")),
    "single absorber beyond": (
        lambda: BARE.replace(absorbers=[cx.Absorber(mass=1), cx.Absorber(mass=1, inner_shell=5)]),
        ("absorbers[1].inner_shell:", "5", "at most 0"),
    ),
    "absorber past a shell": (
        lambda: cx.Absorber(mass=1, linear_stiffness=1e9, shells=(0, 2)),
        ("shells:", "(0, 2)", "have one each", "inner_shell = 0 and outer_shell = 2"),
    ),
    "outer shell beyond": (
        lambda: toml("mass = 10", "mass = 10\nouter_shell = 2"),
        ("absorbers.outer_shell:", "2 is no shell of this system of 2 shells", "at most 1"),
    ),
    "outer shell of a single one": (
        lambda: BARE.replace(shells=BARE.shells[:1], fluids=BARE.fluids[:2], absorbers=[cx.Absorber(mass=1, links="outer", outer_shell=1)]),
        ("absorbers[0].outer_shell:", "1 is no shell of this system of 1 shell", "leave it out"),
    ),
    "outer shell inside": (
        lambda: BARE.replace(absorbers=[{"mass": 1, "z": 0}, {"mass": 1, "z": 0, "inner_shell": 1, "outer_shell": 1}]),
        ("absorbers[1].outer_shell:", "1 does not lie outside inner_shell = 1", "at least 2"),
    ),
    "absorber on rigid": (
        lambda: BARE.replace(shells=[cx.RigidShell(radius=0.5), BARE.shells[1]], absorbers=ring(links="inner")),
        ("absorbers.inner_shell:", "0 links shells[0]", "rigid", "an elastic shell"),
    ),
    "law of no kind": (lambda: ring(law={"type": "gp"}), ("law.type:", "'gp'", "did you mean 'gap'")),
    "law without kind": (lambda: ring(law={"clearance": 1.0}), ("law.type:", "is missing", "friction")),
    "law of a number": (lambda: ring(law=3.0), ("law:", "3.0", "is not a law", "bistable")),
    "law with a bad entry": (lambda: ring(law={"type": "gap", "clearance": -1, "stiffness": 1e9}), ("law.clearance:", "-1", "at least 0")),
    "law in a row with a bad entry": (
        lambda: cx.laws.Parallel([cx.laws.Linear(1e9), {"type": "friction", "force": 0}]),
        ("laws[1].force:", "0"),
    ),
    "law with too many values": (lambda: cx.laws.Linear(1, 2, 3), ("3 values given", "stiffness, damping")),
    "polynomial that lets go": (lambda: cx.laws.Polynomial([1e9, 2.0]), ("coefficients:", "pull back", "odd power")),
    "table that does not rest": (lambda: cx.laws.Table([0.1, 1.0], [0.0, 1.0]), ("force:", "(0, 0)")),
    "table that falls off": (lambda: cx.laws.Table([0.0, 1.0], [0.0, -1.0]), ("force[", "falls off", "pulls back")),
    "table out of order": (lambda: cx.laws.Table([0.0, 1.0, 0.5], [0.0, 1.0, 2.0]), ("stretch[2]:", "0.5", "ascend")),
    "table of unequal lists": (lambda: cx.laws.Table([0.0, 1.0], [0.0, 1.0, 2.0]), ("force:", "3 values for 2", "as many")),
    "friction of two kinds": (lambda: cx.laws.Friction(1.0, speed=1.0, stiffness=1.0), ("speed:", "stiffness", "one of them")),
    "friction that slips early": (lambda: cx.laws.Friction(2.0, 1.0), ("static_force:", "at least 2")),
    "core without a link": (lambda: ring(grounded=True), ("grounded:", "both", '"inner" or "outer"')),
    "law alone without mass": (
        lambda: cx.Absorber(mass=0, law=cx.laws.Cubic(1e9)),
        ("mass:", "law", "linear_stiffness"),
    ),
    "no mass on one shell": (lambda: cx.Absorber(mass=0, linear_stiffness=1e9, links="outer"), ("mass:", "one shell alone")),
    # control
    "gain as text": (lambda: control(proportional="much"), ("proportional:", "'much'", "plain number")),
    "gain with unit": (lambda: control(derivative="3 V"), ("derivative:", "'3 V'", "plain number")),
    "control of nothing": (lambda: control(shells=[]), ("shells:", "[]", "at least one")),
    "control of no shell": (lambda: BARE.replace(control=control(shells=[2])), ("control.shells:", "2", "must be 0 to 1")),
    "control twice": (lambda: BARE.replace(control=control(shells=["inner", 0])), ("control.shells:", "'inner', 0", "once")),
    "control misspelt": (lambda: control(shells="iner"), ("shells:", "'iner'", "'all'", "'inner'")),
    "control without sensor": (
        lambda: SINGLE.replace(control=control()),
        ("control.shells:", "shells[0] has no sensor", "give it one"),
    ),
    "field limit": (lambda: control(field_limit=0), ("field_limit:", "0.0 V/m", "greater than 0")),
    # TOML
    "TOML syntax": (lambda: cx.System.from_toml_string("a = ["), ("TOML:", "Invalid value", "valid TOML")),
    "TOML without shells": (lambda: cx.System.from_toml_string("fluids = []"), ("shells:", "missing")),
    "TOML top-level": (lambda: toml('name = "hybrid"', 'nam = "hybrid"'), ("nam:", "not an entry of System", "'name'")),
    "TOML deep": (
        lambda: toml('thickness = "6 mm"', 'thickness = "-6 mm"'),
        ("shells[0].layers[1].thickness:", "-0.006 m", "greater than 0"),
    ),
    "TOML material": (
        lambda: toml('material = "aluminium"', 'material = "aluminum"'),
        ("shells[0].layers[1].material:", "'aluminum'", "did you mean 'aluminium'?"),
    ),
    "TOML material table": (
        lambda: toml("[source]", "[materials.foam]\ndensity = 3\n[source]"),
        ("materials.foam.youngs_modulus:", "missing"),
    ),
    "TOML source": (lambda: toml('"spherical-shock"', '"sferical-shock"'), ("source.type:", "'sferical-shock'", "'spherical-shock'")),
    "TOML source kind": (lambda: toml('type = "spherical-shock"', ""), ("source.type:", "missing", "plane-shock")),
    "TOML ring": (lambda: toml("mass = 10", 'mass = "10 s"'), ("absorbers.mass:", "'10 s'", "a mass per metre of length")),
    "TOML control": (lambda: toml("derivative = -150", "derivative = inf"), ("control.derivative:", "inf", "not finite")),
    "no file": (lambda: cx.System.from_toml("/nowhere/x.toml"), ("/nowhere/x.toml:", "no such file", "TOML file")),
    # overrides and names
    "unknown path": (lambda: HYBRID.replace_path("source.peak", 1), ("source.peak:", "SphericalShock", "did you mean 'peak_pressure'?")),
    "unknown shell": (lambda: HYBRID.replace_path("shells[7].radius", 1), ("shells[7]:", "'7'", "0, 1, inner, outer")),
    "path too deep": (lambda: HYBRID.replace_path("shells.inner.radius.x", 1), ("shells[0].radius.x:", "no entries of its own")),
    "path without object": (lambda: BARE.replace_path("control.proportional", 1), ("control.proportional:", "not set")),
    "path without absorbers": (lambda: BARE.replace_path("absorbers.count", 1), ("absorbers.count:", "has no absorbers")),
    "path of unknown material": (lambda: BARE.replace_path("materials.alu.density", 1), ("materials.alu:", "'aluminium'")),
    "value of a path": (
        lambda: HYBRID.replace_path("shells.outer.layers[1].thickness", "3 s"),
        ("shells[1].layers[1].thickness:", "'3 s'", "not a length"),
    ),
    "path twice": (lambda: HYBRID.with_overrides({"shells[0].radius": 1, "shells.0.radius": 2}), ("shells.0.radius:", "twice")),
    "empty path": (lambda: HYBRID.replace_path(".", 1), ("'.' is not a path", "source.peak_pressure")),
    "shell name": (lambda: BARE.shell_index("middle"), ("shell:", "'middle'", "0 to 1", "'inner' or 'outer'")),
    "preset name": (lambda: presets.load("hybird"), ("preset:", "'hybird'", "did you mean 'hybrid'?", "iakovlev-double")),
    "change in place": (lambda: setattr(BARE, "name", "x"), ("name:", "cannot be changed", ".replace(name=")),
}


@pytest.mark.parametrize("name", CASES)
def test_message_names_field_value_and_remedy_on_one_line(name: str) -> None:
    act, pieces = CASES[name]
    with pytest.raises(InputError) as caught:
        act()
    message = str(caught.value)
    assert "\n" not in message
    assert [piece for piece in pieces if piece not in message] == [], message
    if pieces[0].endswith(":"):
        assert message.startswith(pieces[0])


@pytest.mark.parametrize(
    ("text", "pieces"),
    [
        ("time,pressure\n0,1\n1,\n2,3\n", ("line 3", "the pressure is missing")),
        ("0,1\n1,nan\n", ("line 2", "pressure 'nan'", "finite")),
        ("0,1\n1,two\n", ("line 2", "pressure 'two'", "finite")),
        ("0,1\n\n# comment\n0,2\n", ("line 4", "time 0.0 s", "increasing")),
        ("-1,1\n0,2\n", ("time", "before t = 0")),
        ("0,1,2\n1,1,2\n", ("3 columns", "pressure_column")),
        ("time,pressure\n0,1\n", ("1 samples", "at least 2")),
        ("", ("0 samples", "at least 2")),
        ("time,pressure\nmore,words\n", ("line 2", "time 'more'")),
    ],
)
def test_csv_errors_name_the_file_and_line(tmp_path: Path, text: str, pieces: tuple[str, ...]) -> None:
    path = tmp_path / "shock.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        cx.Sampled.from_csv(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith((str(path), "time"))
    assert [piece for piece in pieces if piece not in message] == [], message


def test_csv_that_is_missing_or_binary(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        cx.Sampled.from_csv(tmp_path / "none.csv")
    (tmp_path / "binary.csv").write_bytes(b"\x00\x01\x02\x81" * 9)
    with pytest.raises(InputError, match="not a text file"):
        cx.Sampled.from_csv(tmp_path / "binary.csv")
